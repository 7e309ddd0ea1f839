//! Numbers of two bytes for the values of a table: 6 bits of exponent, 10 of mantissa, no sign.
//!
//! The bits are the upper ones of a single-precision number below 2^-62, which is as far as 6 bits of its exponent reach; the unit is 2^-64,
//! so that 1 is near the top. Numbers from 1 down to 2^-62 are kept to half a part in 1024, smaller ones to 2^-73.

/// A number in 0..1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Half(u16);

/// Bits of the mantissa of a single-precision number that are dropped.
const DROPPED: u32 = 13;

/// 2^-64
const UNIT: f64 = 1.0 / (1u128 << 64) as f64;

impl Half {
    pub const ZERO: Half = Half(0);

    /// The nearest to `x`, 0..1.
    pub fn new(x: f64) -> Half {
        let bits = ((x * UNIT) as f32).to_bits();
        Half(((bits + (1 << (DROPPED - 1))) >> DROPPED) as u16)
    }

    /// The number in units of 2^-64.
    pub fn value(self) -> f64 {
        f64::from(f32::from_bits(u32::from(self.0) << DROPPED))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_kept_to_half_a_part_in_a_thousand() {
        for k in 0..60_000 {
            let x = 0.999f64.powi(k);
            let error = Half::new(x).value() / UNIT - x;
            assert!(error.abs() <= x / 2048.0 || x < 4e-19 && error.abs() < 2e-22, "{x}: {error}");
        }
        assert_eq!(Half::new(0.0), Half::ZERO);
        assert_eq!([Half::ZERO.value(), Half::new(1.0).value()], [0.0, UNIT]);
    }
}
