//! The FITS checksum: 32-bit sum in ones' complement, written in letters.
//!
//! Source: FITS Standard 4.0, sec. 4.4.2.7 and appendix J (Seaman, Pence and Rots).

/// Ones' complement sum of big-endian 32-bit words.
#[derive(Clone, Copy, Default)]
pub struct Sum {
    /// Carries are folded at the end: 2^32 words (16 GiB) fit.
    words: u64,
}

impl Sum {
    /// Adds bytes; their number is a multiple of four.
    pub fn add(&mut self, bytes: &[u8]) {
        for word in bytes.chunks_exact(4) {
            self.words += u64::from(u32::from_be_bytes([word[0], word[1], word[2], word[3]]));
        }
        self.words = (self.words & 0xffff_ffff) + (self.words >> 32);
    }

    /// The sum with all carries brought around.
    pub fn total(self) -> u32 {
        let mut total = self.words;
        while total > 0xffff_ffff {
            total = (total & 0xffff_ffff) + (total >> 32);
        }
        total as u32
    }

    /// Sixteen letters and digits that, standing at column 12 of a card in place of zeros, bring the sum to -0.
    pub fn complement_in_ascii(self) -> [u8; 16] {
        let bytes = (!self.total()).to_be_bytes();
        let mut letters = [0; 16];
        for (index, &byte) in bytes.iter().enumerate() {
            for (row, letter) in quarters(byte).into_iter().enumerate() {
                letters[4 * row + index] = letter;
            }
        }
        letters.rotate_right(1); // column 12 is the last byte of a word
        letters
    }
}

/// Four letters or digits whose offsets from '0' add up to `byte`: pairs are pulled apart until no punctuation is left.
fn quarters(byte: u8) -> [u8; 4] {
    let quarter = b'0' + byte / 4;
    let mut letters = [quarter + byte % 4, quarter, quarter, quarter];
    while letters.iter().any(|letter| !letter.is_ascii_alphanumeric()) {
        for pair in letters.chunks_exact_mut(2) {
            if pair.iter().any(|letter| !letter.is_ascii_alphanumeric()) {
                pair[0] += 1;
                pair[1] -= 1;
            }
        }
    }
    letters
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The worked example of the standard, appendix J.
    #[test]
    fn the_example_of_the_standard_is_reproduced() {
        let mut sum = Sum::default();
        sum.add(&868_229_149u32.to_be_bytes());
        assert_eq!(&sum.complement_in_ascii(), b"hcHjjc9ghcEghc9g");
    }

    #[test]
    fn every_byte_is_spelled_without_punctuation() {
        for byte in 0..=255u8 {
            let letters = quarters(byte);
            let sum: u32 = letters.iter().map(|&letter| u32::from(letter - b'0')).sum();
            assert_eq!(sum, u32::from(byte));
            assert!(letters.iter().all(u8::is_ascii_alphanumeric));
        }
    }
}
