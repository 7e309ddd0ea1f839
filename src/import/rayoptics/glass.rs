//! Media of a `.roa` file.
//!
//! | class | is |
//! |---|---|
//! | `Air` | air |
//! | `SchottGlass`, `OharaGlass` ... | a catalogue glass by `gname` |
//! | `ModelGlass` | `n` and `v` at the d line |
//! | `ConstantIndex` | `n`, no dispersion |
//! | `InterpolatedMedium` | `rndx` at `wvls` (nm) |

use super::node::Node;
use crate::error::Problem;
use crate::prescription::Material;

pub fn read(medium: &Node) -> Result<Material, Problem> {
    let values = medium.attributes();
    match medium.class() {
        "Air" => Ok(Material::Air),
        "ModelGlass" => Ok(Material::Model { nd: values.get("n")?.number()?, vd: values.get("v")?.number()? }),
        "ConstantIndex" => Ok(Material::Model { nd: values.get("n")?.number()?, vd: f64::INFINITY }),
        "InterpolatedMedium" => {
            let wavelengths = values.get("wvls")?.numbers()?.into_iter().map(|nm| nm * 1e-9);
            let mut indices: Vec<(f64, f64)> = wavelengths.zip(values.get("rndx")?.numbers()?).collect();
            indices.sort_by(|a, b| a.0.total_cmp(&b.0));
            let name = values.find("label").map_or(Ok(""), |label| label.text())?.to_owned();
            Ok(Material::Private { name, indices })
        }
        class => {
            let maker = class.strip_suffix("Glass").filter(|maker| !maker.is_empty());
            let (Some(maker), Some(name)) = (maker, values.find("gname")) else {
                return Err(medium
                    .problem(format!("no medium {class:?} here"))
                    .expecting("a catalogue or model glass"));
            };
            Ok(Material::Glass { name: name.text()?.to_owned(), maker: Some(maker.to_ascii_uppercase()) })
        }
    }
}
