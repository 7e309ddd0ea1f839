//! The entries.

use super::{Black, Finish, Kind, Model};
use crate::bsdf::Side;

/// All of them, in the order in which they are listed.
pub const LIBRARY: &[Finish] = &[
    sample("black anodize EC1", include_str!("ua-loft/AnoBlackEC1onAlum.bsdf"), ANODIZE, Some(Black::Anodize)),
    sample("black anodize EC2", include_str!("ua-loft/AnoBlackEC2onAlum.bsdf"), ANODIZE, Some(Black::Anodize)),
    sample("black NiTE on Invar", include_str!("ua-loft/AnoBlackNiTEonINVAR.bsdf"), NICKEL, None),
    sample("black NiTE on steel", include_str!("ua-loft/AnoBlackNiTEonSteel.bsdf"), NICKEL, None),
    fitted("black anodize EC1 fit", [0.0102412, 0.0342461, 1.20387, 0.0], ANODIZE, Some(Black::Anodize)),
    fitted("black anodize EC2 fit", [0.0117127, 0.0701343, 1.02195, 0.00283313], ANODIZE, Some(Black::Anodize)),
    fitted("black NiTE on Invar fit", [0.00625413, 0.0311477, 2.15391, 0.0], NICKEL, None),
    fitted("black NiTE on steel fit", [0.00653937, 0.0298695, 2.15879, 0.0], NICKEL, None),
    diffuse("diffuse black anodize", Black::Anodize),
    diffuse("diffuse Kameralack", Black::Kameralack),
    diffuse("diffuse Krylon ultra flat black", Black::Krylon),
    diffuse("diffuse latex flat black", Black::Latex),
    diffuse("diffuse Ultrapol", Black::Ultrapol),
    polished("polished glass 0.5 nm", 0.5e-9, &[Side::Reflect, Side::Transmit]),
    polished("polished glass 1 nm", 1e-9, &[Side::Reflect, Side::Transmit]),
    polished("polished glass 2 nm", 2e-9, &[Side::Reflect, Side::Transmit]),
    polished("polished glass 5 nm", 5e-9, &[Side::Reflect, Side::Transmit]),
    polished("polished mirror 0.5 nm", 0.5e-9, &[Side::Reflect]),
    polished("polished mirror 1 nm", 1e-9, &[Side::Reflect]),
    polished("polished mirror 2 nm", 2e-9, &[Side::Reflect]),
    polished("polished mirror 5 nm", 5e-9, &[Side::Reflect]),
    generic("generic black paint", [1e-3, 0.05, 2.5, 0.04]),
    generic("generic black flock", [2e-4, 0.3, 2.0, 0.004]),
    generic("generic white diffuser", [0.0, 1.0, 0.0, 0.95]),
];

/// Where the total reflectance of a black anodize stays within a fifth of that at 650 nm, m; below 350 nm nothing is known.
const ANODIZE: [f64; 2] = [350e-9, 685e-9];
/// Of black nickel no spectrum is known: the visible, by assumption, m.
const NICKEL: [f64; 2] = [400e-9, 700e-9];

const fn sample(name: &'static str, text: &'static str, range: [f64; 2], like: Option<Black>) -> Finish {
    let source = "UA-LOFT bsdf-tools, 2025; scaled to the TIS that it states, 0.7 (10 deg) to 1.3 (70 deg) of its values' integral; held beyond 80 deg";
    Finish { name, kind: Kind::Measured, source, range, measured_at: Some(650e-9), like, model: Model::Table(text) }
}

/// a (1/sr), b, g and Lambertian reflectance, as `fit-bsdf` finds them through the table of the same name.
const fn fitted(name: &'static str, [a, b, g, reflectance]: [f64; 4], range: [f64; 2], like: Option<Black>) -> Finish {
    let source =
        "ABg + Lambertian through UA-LOFT's values: rms 3 dB, up to 12 dB off; 1.7 (10 deg) to 0.4 (70 deg) of its TIS";
    let model = Model::Abg { a, b, g, reflectance };
    Finish { name, kind: Kind::Fitted, source, range, measured_at: Some(650e-9), like, model }
}

const fn diffuse(name: &'static str, black: Black) -> Finish {
    let source = "UA-LOFT total reflectance; Lambertian by assumption: real blacks are brighter at grazing";
    let range = [350e-9, 2400e-9];
    Finish {
        name,
        kind: Kind::TotalMeasured,
        source,
        range,
        measured_at: None,
        like: None,
        model: Model::Diffuse(black),
    }
}

const fn polished(name: &'static str, rms: f64, sides: &'static [Side]) -> Finish {
    let source = "K-correlation, rms height over 1 to 1000 /mm, b 55 um, s 2; relative to the R and T of the coating (`order: Scaled`)";
    let range = [200e-9, 15e-6];
    let model = Model::Polish { rms, sides };
    Finish { name, kind: Kind::Generic, source, range, measured_at: None, like: None, model }
}

/// a (1/sr), b, g and Lambertian reflectance.
const fn generic(name: &'static str, [a, b, g, reflectance]: [f64; 4]) -> Finish {
    let source = "plausible numbers for a first estimate: bracket them";
    let range = [400e-9, 700e-9];
    let model = Model::Abg { a, b, g, reflectance };
    Finish { name, kind: Kind::Generic, source, range, measured_at: None, like: None, model }
}
