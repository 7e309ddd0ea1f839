//! The grammar of a system file as one commented example, printed by `straylight schema`.
//!
//! The text is a valid system that uses every field and every option once. The tests ask serde for the fields and
//! options of every type, so that the text cannot fall behind the types.

/// Every section, field, option, default and unit of a system file.
pub const SCHEMA: &str = include_str!("schema.ron");

#[cfg(test)]
mod tests {
    use super::SCHEMA;
    use crate::system::document::*;
    use serde::de::DeserializeOwned;
    use std::path::Path;

    /// Names that serde knows in the place where `probe` writes a wrong one.
    fn names<T: DeserializeOwned>(probe: &str) -> &'static [&'static str] {
        match ron::from_str::<T>(probe).err().map(|e| e.code) {
            Some(ron::Error::NoSuchStructField { expected, .. }) => expected,
            Some(ron::Error::NoSuchEnumVariant { expected, .. }) => expected,
            other => panic!("{} answers {other:?} to {probe}", std::any::type_name::<T>()),
        }
    }

    /// True if the text shows the word: as `name:` outside comments if it is a field, else anywhere.
    fn shown(name: &str, is_field: bool) -> bool {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        SCHEMA.lines().map(|line| if is_field { line.split("//").next().unwrap_or("") } else { line }).any(|line| {
            line.match_indices(name).any(|(at, _)| {
                let after = &line[at + name.len()..];
                let alone = !line[..at].ends_with(word) && !after.starts_with(word);
                alone && (!is_field || after.starts_with(':'))
            })
        })
    }

    /// Every field of a struct is shown.
    fn fields<T: DeserializeOwned>() {
        for name in names::<T>("(zzz: 1)") {
            assert!(shown(name, true), "the schema lacks the field {name} of {}", std::any::type_name::<T>());
        }
    }

    /// Every option of an enum, and every field of each option, is shown.
    fn options<T: DeserializeOwned>() {
        for option in names::<T>("Zzz") {
            assert!(shown(option, false), "the schema lacks {option} of {}", std::any::type_name::<T>());
            if let Err(ron::Error::NoSuchStructField { expected, .. }) =
                ron::from_str::<T>(&format!("{option}(zzz: 1)")).map_err(|e| e.code)
            {
                expected.iter().for_each(|name| assert!(shown(name, true), "the schema lacks {name} of {option}"));
            }
        }
    }

    fn schema() -> Document {
        Document::parse(Path::new("schema.ron"), SCHEMA.as_bytes()).unwrap_or_else(|e| panic!("{:#?}", e.problems()))
    }

    #[test]
    fn the_schema_is_a_valid_system() {
        assert_eq!(schema().warnings, []);
    }

    #[test]
    fn the_schema_shows_every_section_field_and_option() {
        SECTIONS.iter().for_each(|name| assert!(shown(name, true), "the schema lacks the section {name}"));
        fields::<Geometry>();
        fields::<Change>();
        fields::<Replacement>();
        options::<About>();
        fields::<Element>();
        fields::<Optical>();
        fields::<Exact>();
        fields::<Surface>();
        fields::<Finish>();
        fields::<Source>();
        fields::<Sweep>();
        fields::<Glare>();
        fields::<Thermal>();
        fields::<Mask>();
        options::<Angles>();
        fields::<Detector>();
        fields::<Requirement>();
        options::<Limit>();
        fields::<Run>();
        fields::<Roulette>();
        fields::<Bracket>();
        options::<Up>();
        options::<Body>();
        options::<Form>();
        options::<Relative>();
        options::<Medium>();
        options::<Bulk>();
        options::<Coating>();
        options::<Specular>();
        options::<Scatter>();
        options::<ScatterSide>();
        options::<Unmeasured>();
        options::<ScatterAxis>();
        options::<Roughness>();
        options::<FacetLaw>();
        options::<Facets>();
        options::<FacetEnergy>();
        options::<Order>();
        options::<Side>();
        options::<Scattering>();
        options::<Gap>();
        options::<Selector>();
        options::<Predicate>();
        options::<Extent>();
        options::<Angular>();
        options::<Spectrum>();
        options::<Polarization>();
        options::<Handedness>();
        options::<Receiver>();
        options::<Target>();
        options::<Importance>();
        options::<Way>();
        options::<Quantity>();
        options::<Bins>();
        options::<Counts>();
        options::<Region>();
    }

    #[test]
    fn a_field_that_the_schema_calls_default_has_that_value_when_left_out() {
        let written = schema().system;
        let bare = "System(geometry: [(file: \"parts.glb\")], sources: {\"s\": (flux: \"1 W\", extent: Node(name: \"a\"), \
                    angular: Lambertian, spectrum: Line(\"550 nm\"))}, surfaces: [(on: Faces(of: \"a\", where: \
                    Nearest(point: \"(0, 5, 0) mm\")))], detectors: {\"d\": (on: Node(\"a\"), quantity: Irradiance)})";
        let bare = Document::parse(Path::new("bare.ron"), bare.as_bytes()).unwrap_or_else(|e| panic!("{e}")).system;
        assert_eq!(bare.geometry, written.geometry);
        assert_eq!(bare.ambient, written.ambient);
        let defaults = Run {
            batch: None,
            max_scatters: None,
            max_reflections: None,
            max_events: None,
            until: None,
            ..written.run
        };
        assert_eq!(bare.run, defaults);
        assert_eq!(bare.sources.get("s").map(|s| s.polarization), Some(Polarization::Unpolarized));
        assert!(matches!(bare.sources.get("s").map(|s| &s.extent), Some(Extent::Node { side: Side::Front, .. })));
        assert_eq!(bare.detectors.get("d").map(|d| d.side), Some(Side::Both));
        assert_eq!(
            (Order::default(), Side::default(), Gap::default()),
            (Order::ScatterFirst, Side::Both, Gap::Contact)
        );
        let Some(Selector::Any(parts)) = written.surfaces.last().map(|s| s.on.clone()) else { panic!("no Any") };
        let Selector::Faces { predicate, .. } = &bare.surfaces[0].on else { panic!("no Faces") };
        assert!(matches!(&parts[0], Selector::Faces { predicate: shown, .. } if shown == predicate));
    }
}
