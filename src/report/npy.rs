//! Maps for NumPy: `np.load("fpa.npy")` gives an array of doubles, shape (rows, columns), row-major, row 0 first.
//!
//! Source: NEP 1, "A simple file format for NumPy arrays", version 1.0.

use std::io::{self, Write};

/// Writes `values` (shape = [rows, columns]) as little-endian doubles.
pub fn write(out: &mut impl Write, shape: [usize; 2], values: &[f64]) -> io::Result<()> {
    out.write_all(&header(shape))?;
    values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
}

/// Magic, version, length, and a Python dictionary padded with spaces to a multiple of 64 bytes, ended by a newline.
fn header([rows, columns]: [usize; 2]) -> Vec<u8> {
    const PREFIX: usize = 10;
    let mut text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    let padding = 63 - (PREFIX + text.len()) % 64;
    text.extend(std::iter::repeat_n(' ', padding));
    text.push('\n');
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend((text.len() as u16).to_le_bytes()); // two shape numbers: never near 65536
    header.extend(text.as_bytes());
    header
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_start_at_a_multiple_of_64_bytes() {
        for columns in [1, 9, 10, 99, 12_345_678] {
            let mut bytes = Vec::new();
            write(&mut bytes, [3, columns], &[1.5, -2.0]).unwrap();
            assert_eq!((bytes.len() - 16) % 64, 0);
            assert_eq!(bytes[bytes.len() - 16..bytes.len() - 8], 1.5f64.to_le_bytes());
            assert_eq!(bytes[bytes.len() - 17], b'\n');
        }
    }
}
