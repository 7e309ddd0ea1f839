//! Where the bytes of a buffer come from: a data URI, or a plain file beside the .gltf and nowhere else.

use crate::error::Problem;
use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// Content of a regular file of at most `most` bytes. A pipe or a device is refused before it is opened.
pub fn read_file(path: &Path, most: u64) -> Result<Vec<u8>, Problem> {
    let fault = |fault: std::io::Error| Problem::error(format!("cannot be read: {fault}"));
    let about = fs::metadata(path).map_err(fault)?;
    if !about.is_file() {
        return Err(Problem::error("is not a regular file"));
    }
    if about.len() > most {
        return Err(Problem::error(format!("has {} bytes; at most {most} are read", about.len())));
    }
    let mut bytes = Vec::with_capacity(about.len() as usize);
    File::open(path).map_err(fault)?.take(most).read_to_end(&mut bytes).map_err(fault)?;
    Ok(bytes)
}

/// Bytes of a buffer of `length` bytes at `uri`, and the file they were read from. `folder`: where the .gltf is.
pub fn load(uri: &str, length: u64, folder: &Path) -> Result<(Vec<u8>, Option<PathBuf>), Problem> {
    if let Some(data) = uri.strip_prefix("data:") {
        return Ok((decode(data)?, None));
    }
    let path = beside(uri, folder)?;
    let about = fs::metadata(&path).map_err(|fault| missing(uri, &fault.to_string()))?;
    if !about.is_file() {
        return Err(Problem::error(format!("`{}` is not a regular file", super::shorten(uri))));
    }
    if about.len() < length {
        let problem = format!("`{}` has {} bytes, but byteLength is {length}", super::shorten(uri), about.len());
        return Err(Problem::error(problem));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    let file = File::open(&path).map_err(|fault| missing(uri, &fault.to_string()))?;
    file.take(length).read_to_end(&mut bytes).map_err(|fault| missing(uri, &fault.to_string()))?;
    Ok((bytes, Some(path)))
}

fn missing(uri: &str, fault: &str) -> Problem {
    Problem::error(format!("`{}` cannot be read: {fault}", super::shorten(uri)))
}

/// What follows `data:`; `[<type>];base64,<data>` is the only form glTF allows for buffers.
fn decode(data: &str) -> Result<Vec<u8>, Problem> {
    let Some((_, text)) = data.split_once(";base64,").filter(|(kind, _)| !kind.contains(',')) else {
        return Err(Problem::error("data URI is not base64").expecting("`data:application/octet-stream;base64,...`"));
    };
    let config = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, config);
    engine.decode(text).map_err(|fault| Problem::error(format!("base64 data is damaged: {fault}")))
}

/// The path of a relative URI; refuses schemes, absolute paths, `..`, and links that lead out of `folder`.
fn beside(uri: &str, folder: &Path) -> Result<PathBuf, Problem> {
    let refuse = |why: &str| {
        Problem::error(format!("URI `{}` {why}", super::shorten(uri))).expecting("a file in the folder of the .gltf")
    };
    let name = unescape(uri).ok_or_else(|| refuse("is not UTF-8 after percent-decoding"))?;
    if name.is_empty() || name.chars().any(char::is_control) {
        return Err(refuse("is empty or contains control characters"));
    }
    if name.contains(':') || name.contains('\\') {
        return Err(refuse("is not a relative path"));
    }
    if !Path::new(&name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(refuse("leads out of the folder"));
    }
    let path = folder.join(&name);
    let inside = |path: &Path| Some(path.canonicalize().ok()?.starts_with(folder.canonicalize().ok()?));
    match inside(&path) {
        None => Err(refuse("names no file that can be read")),
        Some(false) => Err(refuse("is a link that leads out of the folder")),
        Some(true) => Ok(path),
    }
}

/// `%41` -> `A`; `None` if the result is not UTF-8. A `%` without two digits stands for itself, as in file names.
fn unescape(uri: &str) -> Option<String> {
    let bytes = uri.as_bytes();
    let digit = |at: usize| bytes.get(at).and_then(|byte| (*byte as char).to_digit(16));
    let (mut out, mut at) = (Vec::with_capacity(bytes.len()), 0);
    while at < bytes.len() {
        match (bytes[at], digit(at + 1), digit(at + 2)) {
            (b'%', Some(high), Some(low)) => {
                out.push((16 * high + low) as u8);
                at += 3;
            }
            (byte, ..) => {
                out.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8(out).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_beside_the_document_are_read() {
        let folder = tempfile::tempdir().expect("folder");
        let inside = folder.path().join("inside");
        fs::create_dir(&inside).expect("folder");
        fs::write(folder.path().join("secret.bin"), b"secret").expect("file");
        fs::write(inside.join("my part.bin"), b"part").expect("file");
        assert_eq!(load("my%20part.bin", 4, &inside).expect("reads").0, b"part");
        assert_eq!(load("./my part.bin", 2, &inside).expect("reads").0, b"pa");
        for uri in ["../secret.bin", "%2e%2e/secret.bin", "/etc/passwd", "file:///etc/passwd", "C:\\x", "", "none.bin"]
        {
            assert!(load(uri, 1, &inside).is_err(), "{uri}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(folder.path().join("secret.bin"), inside.join("link.bin")).expect("link");
            assert!(load("link.bin", 1, &inside).is_err(), "a link out of the folder");
        }
        assert!(load("my%20part.bin", 5, &inside).is_err(), "shorter than said");
        assert_eq!(load("data:;base64,AAEC", 3, &inside).expect("reads").0, [0, 1, 2]);
        assert!(load("data:text/plain,abc", 3, &inside).is_err());
    }
}
