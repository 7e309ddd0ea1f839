//! meshes
