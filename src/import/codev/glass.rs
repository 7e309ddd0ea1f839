//! Names of glasses in a sequence file: `NBK7_SCHOTT`, `517642`, `1.517:64.2`, `'MINE'`.

use crate::prescription::Material;

/// The material of a name; `private` are the names and indices (wavelength m, index) that the file lists itself. `None` for an empty name.
pub fn named(name: &str, private: &[(String, Vec<(f64, f64)>)]) -> Option<Material> {
    let upper = name.to_ascii_uppercase();
    if let Some((name, indices)) = private.iter().find(|(own, _)| own.eq_ignore_ascii_case(name)) {
        return Some(Material::Private { name: name.clone(), indices: indices.clone() });
    }
    match upper.as_str() {
        "" => return None,
        "AIR" => return Some(Material::Air),
        "REFL" | "REFLECT" => return Some(Material::Mirror),
        _ => (),
    }
    if let Some(model) = fictitious(name) {
        return Some(model);
    }
    Some(match name.rsplit_once('_') {
        Some((glass, maker)) if !glass.is_empty() && !maker.is_empty() => {
            Material::Glass { name: glass.to_owned(), maker: Some(maker.to_owned()) }
        }
        _ => Material::Glass { name: name.to_owned(), maker: None },
    })
}

/// `517642` and `517.642`: nd - 1 in thousandths, vd in tenths; `1.5168:64.17` in full.
fn fictitious(name: &str) -> Option<Material> {
    if let Some((nd, vd)) = name.split_once(':') {
        let (nd, vd) = (nd.parse::<f64>().ok()?, vd.parse::<f64>().ok()?);
        return (nd >= 1.0 && nd.is_finite() && vd.is_finite()).then_some(Material::Model { nd, vd });
    }
    let digits: String = name.chars().filter(|c| *c != '.').collect();
    let point = name.find('.').is_none_or(|at| at == 3 || at == 6);
    if digits.len() != 6 || !point || !digits.chars().all(|c| c.is_ascii_digit()) {
        return None;
    }
    let (index, abbe) = digits.split_at(3);
    let (index, abbe) = (index.parse::<f64>().ok()?, abbe.parse::<f64>().ok()?);
    Some(Material::Model { nd: 1.0 + index / 1000.0, vd: abbe / 10.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_what_kind_of_glass_it_is() {
        let glass = |name: &str, maker: Option<&str>| {
            Some(Material::Glass { name: name.to_owned(), maker: maker.map(str::to_owned) })
        };
        assert_eq!(named("NBK7_SCHOTT", &[]), glass("NBK7", Some("SCHOTT")));
        assert_eq!(named("SILICA", &[]), glass("SILICA", None));
        assert_eq!(named("refl", &[]), Some(Material::Mirror));
        for name in ["517642", "517.642", "517642.", "1.517:64.2"] {
            assert_eq!(named(name, &[]), Some(Material::Model { nd: 1.517, vd: 64.2 }), "{name}");
        }
        let own = [("mine".to_owned(), vec![(5e-7, 1.5)])];
        assert!(matches!(named("MINE", &own), Some(Material::Private { .. })));
        assert_eq!(named("", &[]), None);
    }
}
