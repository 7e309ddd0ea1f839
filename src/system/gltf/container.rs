//! From bytes to a document: .glb or .gltf, told apart by their first bytes, not by the name.
//!
//! A .glb is a header (magic, version 2, length) and chunks (length, type, bytes): JSON first, then at most one BIN.
//! Source: Khronos, glTF 2.0 specification (2021), section 4.4.

use super::document::Root;
use super::uri;
use crate::error::{Problem, Span};
use std::ops::Range;
use std::path::Path;

/// Largest file read, bytes: 2^32, which is also what the length field of a .glb can say.
const MOST_BYTES: u64 = 1 << 32;
/// Largest JSON text read, bytes.
const MOST_JSON: usize = 1 << 28;
/// Deepest nesting of JSON arrays and objects; what `serde_json` itself allows.
const MOST_NESTED: usize = 128;

const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// The bytes of a file and where its two parts lie in them.
pub struct Container {
    pub bytes: Vec<u8>,
    json: Range<usize>,
    pub bin: Option<Range<usize>>,
    pub warnings: Vec<Problem>,
}

impl Container {
    /// Reads a whole file: a regular one, of bearable size.
    pub fn read(path: &Path) -> Result<Container, Problem> {
        let bytes = uri::read_file(path, MOST_BYTES)?;
        if bytes.starts_with(b"version https://git-lfs") {
            return Err(
                Problem::error("is a Git LFS pointer, not the file itself").hinting("run `git lfs pull`".to_owned())
            );
        }
        if bytes.is_empty() {
            return Err(Problem::error("is empty").expecting("a .gltf or .glb file"));
        }
        let mut container = Container { json: 0..bytes.len(), bytes, bin: None, warnings: Vec::new() };
        if container.bytes.starts_with(b"glTF") {
            container.split()?;
        }
        Ok(container)
    }

    fn word(&self, at: usize) -> Option<u32> {
        let bytes = self.bytes.get(at..at.checked_add(4)?)?;
        Some(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }

    /// Finds the chunks of a .glb.
    fn split(&mut self) -> Result<(), Problem> {
        let (Some(version), Some(length)) = (self.word(4), self.word(8)) else {
            return Err(Problem::error("GLB header is cut short").expecting("12 bytes"));
        };
        if version != 2 {
            return Err(Problem::error(format!("is GLB version {version}")).expecting("version 2"));
        }
        let (length, actual) = (length as usize, self.bytes.len());
        if length < 20 {
            return Err(Problem::error(format!("GLB header says {length} bytes")).expecting("20 at least"));
        }
        if length > actual {
            let problem = format!("GLB header says {length} bytes, but the file has {actual}");
            return Err(Problem::error(problem).hinting("the file may have been cut short".to_owned()));
        }
        if length < actual {
            let problem = format!("{} bytes after the end of the GLB container are ignored", actual - length);
            self.warnings.push(Problem::warning(problem));
        }
        let mut at = 12;
        for number in 0.. {
            if at == length {
                break;
            }
            let (kind, range) = self.chunk(at, length, number)?;
            at = range.end;
            self.place(number, kind, range)?;
        }
        Ok(())
    }

    /// Type and content of the chunk that starts at `at`.
    fn chunk(&self, at: usize, end: usize, number: usize) -> Result<(u32, Range<usize>), Problem> {
        let short = || Problem::error(format!("GLB chunk {number} is cut short"));
        let (Some(size), Some(kind)) = (self.word(at), self.word(at + 4)) else { return Err(short()) };
        let start = at + 8;
        let stop = start.checked_add(size as usize).filter(|&stop| stop <= end).ok_or_else(short)?;
        Ok((kind, start..stop))
    }

    fn place(&mut self, number: usize, kind: u32, range: Range<usize>) -> Result<(), Problem> {
        match (number, kind) {
            (0, JSON) => self.json = range,
            (0, _) => return Err(Problem::error("first GLB chunk is not JSON")),
            (1, BIN) => self.bin = Some(range),
            (_, JSON | BIN) => {
                return Err(Problem::error(format!("GLB chunk {number} repeats a chunk or is misplaced")));
            }
            _ => {} // The specification has readers ignore chunks of other types.
        }
        Ok(())
    }

    /// The document; refuses what is not UTF-8, not JSON, or nested so deep that reading it is an attack.
    pub fn document(&self) -> Result<Root, Problem> {
        let bytes = &self.bytes[self.json.clone()];
        if bytes.len() > MOST_JSON {
            return Err(Problem::error(format!("JSON text is larger than {} MB", MOST_JSON >> 20)));
        }
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let text = std::str::from_utf8(bytes).map_err(|fault| not_utf8(bytes, fault.valid_up_to()))?;
        if text.trim().is_empty() {
            return Err(Problem::error("JSON text is empty"));
        }
        if !text.trim_start().starts_with('{') {
            return Err(Problem::error("is neither a glTF JSON object nor a GLB container"));
        }
        if nesting(bytes) > MOST_NESTED {
            return Err(Problem::error(format!("JSON is nested more than {MOST_NESTED} deep")));
        }
        let mut json = serde_json::Deserializer::from_str(text);
        let root: Root = serde_path_to_error::deserialize(&mut json)
            .map_err(|fault| self.refused(&fault.path().to_string(), fault.inner()))?;
        json.end().map_err(|fault| self.refused(".", &fault))?;
        Ok(root)
    }

    fn refused(&self, path: &str, fault: &serde_json::Error) -> Problem {
        // serde_json ends its messages with the place, which stands in front of ours.
        let text = fault.to_string();
        let message = text.rsplit_once(" at line ").map_or(text.as_str(), |(message, _)| message);
        let problem = Problem::error(super::shorten(message)).on(if matches!(path, "." | "?") {
            String::new()
        } else {
            super::shorten(path)
        });
        if self.json.start > 0 {
            return problem; // Lines within a .glb are of no use to anybody.
        }
        problem.at(Span { line: fault.line().max(1) as u32, column: fault.column().max(1) as u32, len: 1 })
    }
}

fn not_utf8(bytes: &[u8], valid: usize) -> Problem {
    let problem = Problem::error(format!("is not UTF-8 (byte {valid})")).expecting("glTF JSON in UTF-8");
    match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => problem.hinting("the file is UTF-16: convert it".to_owned()),
        _ => problem,
    }
}

/// Deepest nesting of brackets outside strings.
fn nesting(json: &[u8]) -> usize {
    let (mut depth, mut deepest) = (0usize, 0);
    let (mut quoted, mut escaped) = (false, false);
    for byte in json {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if quoted => escaped = true,
            b'"' => quoted = !quoted,
            b'[' | b'{' if !quoted => depth += 1,
            b']' | b'}' if !quoted => depth = depth.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    deepest
}
