//! Checks of coatings.

use super::{Checker, Section};
use crate::error::Problem;
use crate::system::document::tree::{Node, Shape};
use crate::system::document::{Coating, Layer, Row, Thickness, read};

/// Most layers of a stack, repetitions written out: a design has some hundred.
const MOST_LAYERS: u64 = 10_000;

impl<'a> Checker<'a> {
    pub(super) fn coatings(&mut self) {
        let document = self.document;
        for (name, coating) in document.system.coatings.iter() {
            let path = format!("coatings[{name:?}]");
            self.coating(coating, &path);
            match coating {
                Coating::Opaque { medium } => self.refer(Section::Media, medium, &format!("{path}.medium")),
                Coating::Stack { layers, substrate, .. } => {
                    self.films(layers, &format!("{path}.layers"));
                    self.substrate(substrate.as_deref(), &path);
                }
                Coating::Zemax { substrate, .. } => self.substrate(substrate.as_deref(), &path),
                _ => {}
            }
        }
    }

    fn substrate(&mut self, substrate: Option<&'a str>, path: &str) {
        if let Some(medium) = substrate {
            self.refer(Section::Media, medium, &format!("{path}.substrate"));
        }
    }

    /// What one coating says, apart from the names it uses.
    pub(super) fn coating(&mut self, coating: &Coating, path: &str) {
        match coating {
            Coating::Fresnel | Coating::Opaque { .. } => {}
            Coating::Ideal { reflectance, transmittance } => {
                self.shares(&[("reflectance", *reflectance), ("transmittance", *transmittance)], path);
            }
            Coating::Mirror { reflectance } => self.fraction(*reflectance, &format!("{path}.reflectance")),
            Coating::Metal { n, k } => {
                self.positive(*n, &format!("{path}.n"));
                self.not_negative(*k, &format!("{path}.k"));
            }
            Coating::Splitter { reflectance, transmittance } => {
                for (at, (r, t)) in
                    [(reflectance.0, transmittance.0), (reflectance.1, transmittance.1)].iter().enumerate()
                {
                    self.shares(&[(&format!("reflectance[{at}]"), *r), (&format!("transmittance[{at}]"), *t)], path);
                }
            }
            Coating::Polarizer { axis: _, transmittance, leakage } => {
                self.fraction(*transmittance, &format!("{path}.transmittance"));
                self.fraction(*leakage, &format!("{path}.leakage"));
            }
            Coating::Retarder { axis: _, retardance } => self.finite(retardance.0, &format!("{path}.retardance")),
            Coating::Stack { layers, design, .. } => {
                design.iter().for_each(|design| self.wavelength(*design, &format!("{path}.design")));
                let count = layers.iter().fold(0u64, |sum, layer| sum.saturating_add(layer.count()));
                self.require(count <= MOST_LAYERS, &format!("{path}.layers"), || {
                    Problem::error(format!("these are {count} layers")).expecting(format!("at most {MOST_LAYERS}"))
                });
                let waves = layers.iter().any(counts_waves);
                self.require(!waves || design.is_some(), path, || {
                    Problem::error("thicknesses are given in waves, but not of which wavelength")
                        .expecting("`design: \"550 nm\"`")
                });
            }
            Coating::Table { file, rows } => self.table(file.is_some(), rows.as_deref(), path),
            Coating::Zemax { file, coating, design, substrate: _ } => {
                self.file(file, path);
                self.not_empty(coating, &format!("{path}.coating"), "the name of the coating");
                design.iter().for_each(|design| self.wavelength(*design, &format!("{path}.design")));
            }
        }
    }

    fn films(&mut self, layers: &'a [Layer], path: &str) {
        for (at, layer) in layers.iter().enumerate() {
            let path = format!("{path}[{at}]");
            self.layer_name(layer, &path);
            match layer {
                Layer::Film(medium, thickness) => {
                    self.refer(Section::Media, medium, &format!("{path}[0]"));
                    let (Thickness::Length(size) | Thickness::Waves(size)) = *thickness;
                    self.not_negative(size, &format!("{path}[1]"));
                }
                Layer::Repeat(times, layers) => {
                    self.range(*times > 0, &format!("{path}[0]"), "at least 1");
                    self.require(!layers.is_empty(), &format!("{path}[1]"), || Problem::error("no layers to repeat"));
                    self.films(layers, &format!("{path}[1]"));
                }
            }
        }
    }

    /// A film has no name before its parentheses; what repeats has none or its own.
    fn layer_name(&mut self, layer: &Layer, path: &str) {
        let node: Option<&Node> = read::steps(path).and_then(|steps| self.document.tree.find(&steps));
        let Some(node) = node else { return };
        let items = match &node.shape {
            Shape::Items(items) => items.len(),
            _ => 2,
        };
        self.require(items == 2, path, || {
            Problem::error("a layer has two parts").expecting("(\"medium\", \"thickness\"), or Repeat(times, [layers])")
        });
        let fits = match (layer, node.name.as_deref()) {
            (_, None) => true,
            (Layer::Repeat(..), Some(name)) => name == "Repeat",
            (Layer::Film(..), Some(_)) => false,
        };
        let name = node.name.clone().unwrap_or_default();
        self.require(fits, path, || {
            Problem::error(format!("there is no `{name}` here"))
                .expecting("(\"medium\", \"thickness\"), or Repeat(times, [layers])")
        });
    }

    fn table(&mut self, file: bool, rows: Option<&[Row]>, path: &str) {
        self.require(file != rows.is_some(), path, || {
            let what = if file { "both `file` and `rows` are given" } else { "no table is given" };
            Problem::error(what).expecting("one of `file` and `rows`")
        });
        for (at, row) in rows.unwrap_or_default().iter().enumerate() {
            let path = format!("{path}.rows[{at}]");
            self.wavelength(row.0, &format!("{path}[0]"));
            let degrees = row.1.0.to_degrees();
            self.range((0.0..=90.0 + 1e-9).contains(&degrees), &format!("{path}[1]"), "an angle from 0 deg to 90 deg");
            for (column, share) in [row.2, row.3, row.4, row.5].into_iter().enumerate() {
                self.fraction(share, &format!("{path}[{}]", column + 2));
            }
        }
    }
}

fn counts_waves(layer: &Layer) -> bool {
    match layer {
        Layer::Film(_, thickness) => matches!(thickness, Thickness::Waves(_)),
        Layer::Repeat(_, layers) => layers.iter().any(counts_waves),
    }
}
