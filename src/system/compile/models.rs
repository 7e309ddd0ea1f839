//! Coatings and finishes: from what the document says to what light meets.

use super::Shop;
use super::scatter::lobes;
use crate::coating::{self, Coating};
use crate::error::Problem;
use crate::scene::Filling;
use crate::surface::{Order, Scattering, Surface};
use crate::system::document as written;
use num_complex::Complex64;

/// The interface that a coating names.
pub fn coating(written: &written::Coating, media: &[Filling]) -> Box<dyn Coating> {
    match written {
        written::Coating::Fresnel => Box::new(coating::Bare),
        written::Coating::Ideal { reflectance, transmittance } => {
            Box::new(coating::Ideal { reflectance: *reflectance, transmittance: *transmittance })
        }
        written::Coating::Mirror { reflectance } => Box::new(coating::Mirror { reflectance: *reflectance }),
        written::Coating::Metal { n, k } => Box::new(coating::Metal { index: Complex64::new(*n, *k) }),
        written::Coating::Opaque { medium } => {
            // Every name is defined: the document has been checked.
            let filling = media.iter().find(|filling| filling.label == *medium).unwrap_or(&media[0]);
            Box::new(coating::Opaque { medium: filling.medium.clone() })
        }
    }
}

/// What one side of a part is, with every field settled.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finish {
    /// `None`: nothing was said.
    pub specular: Option<written::Specular>,
    pub coating: Option<String>,
    pub scatter: Option<String>,
    pub order: written::Order,
    pub scattering: written::Scattering,
}

impl Finish {
    /// True if nothing was said about what the surface does.
    pub fn is_unsaid(&self) -> bool {
        self.specular.is_none() && self.coating.is_none() && self.scatter.is_none()
    }

    /// "Fresnel", "coating ar + scatter black", ... for people.
    pub fn label(&self) -> String {
        let specular = match (&self.specular, &self.coating) {
            (_, Some(name)) => format!("coating {name}"),
            (Some(specular), None) => format!("{specular:?}"),
            (None, None) => "Absorb".into(),
        };
        let scatter = self.scatter.as_ref().map(|name| format!(" + scatter {name}")).unwrap_or_default();
        specular + &scatter
    }

    /// The surface that light meets.
    pub fn surface(&self, shop: &mut Shop, media: &[Filling]) -> Surface {
        let named = |name: &String| shop.document.system.coatings.get(name).cloned();
        let specular = match &self.coating {
            Some(name) => named(name),
            None => self.specular.and_then(written::Specular::coating),
        };
        let document = shop.document;
        let scatter = self.scatter.as_ref().and_then(|name| Some((name, document.system.scatter.get(name)?)));
        if let Some((name, _)) =
            scatter.filter(|(_, model)| model.is_of_shape() && self.order != written::Order::Scaled)
        {
            let what = format!("{:?} scatters by its shape alone, and this surface says nothing of its R and T", name);
            let problem = Problem::error(what).expecting("`order: Scaled` on every surface that has it");
            shop.fault(&format!("scatter[{name:?}]"), problem);
        }
        let lobes = scatter.map_or(Vec::new(), |(name, model)| lobes(shop, model, &format!("scatter[{name:?}]")));
        let order = match self.order {
            written::Order::ScatterFirst => Order::ScatterFirst,
            written::Order::Scaled => Order::Scaled,
            written::Order::Total => Order::Total,
        };
        let scattering = match self.scattering {
            written::Scattering::On => Scattering::On,
            written::Scattering::Off => Scattering::Off,
        };
        Surface::new(self.label(), specular.map(|written| coating(&written, media)), lobes, order, scattering)
    }
}
