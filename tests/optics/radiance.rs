//! radiance
