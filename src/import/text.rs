//! Bytes of a text file to text: UTF-16 with its mark (as Zemax writes), UTF-8, else Latin-1.

use crate::error::Problem;

/// The text without byte-order mark. Fails on UTF-16 that is cut or broken.
pub fn decode(bytes: &[u8]) -> Result<String, Problem> {
    match bytes {
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, rest @ ..] => Ok(narrow(rest)),
        _ => Ok(narrow(bytes)),
    }
}

fn wide(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, Problem> {
    let (pairs, odd) = bytes.as_chunks::<2>();
    let units: Vec<u16> = pairs.iter().map(|pair| unit(*pair)).collect();
    match String::from_utf16(&units) {
        Ok(text) if odd.is_empty() => Ok(text),
        _ => Err(Problem::error("the text is cut or broken")
            .expecting("whole UTF-16 characters, as its first two bytes say")),
    }
}

fn narrow(bytes: &[u8]) -> String {
    std::str::from_utf8(bytes).map_or_else(|_| bytes.iter().map(|&b| char::from(b)).collect(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_reads_the_same() {
        let text = "UNIT MM µ";
        let wide = |mark: u16, bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
            std::iter::once(mark).chain(text.encode_utf16()).flat_map(bytes).collect()
        };
        let latin: Vec<u8> = text.chars().map(|c| u32::from(c) as u8).collect();
        let marked = [b"\xef\xbb\xbf".as_slice(), text.as_bytes()].concat();
        for bytes in [wide(0xfeff, u16::to_le_bytes), wide(0xfeff, u16::to_be_bytes), marked, text.into(), latin] {
            assert_eq!(decode(&bytes).expect("text"), text);
        }
    }

    #[test]
    fn cut_utf_16_is_refused() {
        assert!(decode(b"\xff\xfeU").is_err());
        assert!(decode(b"\xff\xfe\x00\xd8").is_err());
    }
}
