//! Finishes: from what the document says to what light meets.

use super::Shop;
use super::coatings::{Coatings, faces};
use super::scatter::{deposit, levelled};
use crate::coating::Side;
use crate::error::Problem;
use crate::scene::Filling;
use crate::surface::{Order, Scattering, Surface};
use crate::system::document as written;
use crate::system::units::Direction;

/// What one side of a part is, with every field settled.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finish {
    /// `None`: nothing was said.
    pub specular: Option<written::Specular>,
    pub coating: Option<String>,
    pub scatter: Option<String>,
    pub order: written::Order,
    pub scattering: written::Scattering,
    /// Direction from which azimuths count, of scatter that depends on them.
    pub lay: Option<Direction>,
    /// The side it is on, of a coating or a scatter model that is not the same from both.
    pub side: Option<Side>,
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
    pub fn surface(&self, shop: &mut Shop, media: &[Filling], coatings: &Coatings) -> Surface {
        let found = match &self.coating {
            Some(name) => coatings.get(name).cloned(),
            None => {
                let written = self.specular.and_then(written::Specular::coating);
                written.and_then(|written| faces(shop, &written, media, "surfaces"))
            }
        };
        let specular = found.map(|[front, back]| if self.side == Some(Side::Back) { back } else { front });
        let document = shop.document;
        let scatter = self.scatter.as_ref().and_then(|name| Some((name, document.system.scatter.get(name)?)));
        if let Some((name, _)) =
            scatter.filter(|(_, model)| model.is_of_shape() && self.order != written::Order::Scaled)
        {
            let what = format!("{:?} scatters by its shape alone, and this surface says nothing of its R and T", name);
            let problem = Problem::error(what).expecting("`order: Scaled` on every surface that has it");
            shop.fault(&format!("scatter[{name:?}]"), problem);
        }
        let side = self.side.unwrap_or(Side::Front);
        let lobes = scatter.map_or(Vec::new(), |(name, model)| levelled(shop, name, model, side));
        let lay = self.lay.map(|lay| lay.0);
        if let Some((name, _)) = scatter.filter(|_| lay.is_none() && lobes.iter().any(|lobe| lobe.anisotropic())) {
            let what = format!("{name:?} depends on the azimuth of the light, and this surface has no lay");
            let problem = Problem::error(what).expecting("`lay: \"(x, y, z)\"` on every surface that has it");
            shop.fault(&format!("scatter[{name:?}]"), problem);
        }
        let order = match self.order {
            written::Order::ScatterFirst => Order::ScatterFirst,
            written::Order::Scaled => Order::Scaled,
            written::Order::Total => Order::Total,
        };
        let scattering = match self.scattering {
            written::Scattering::On => Scattering::On,
            written::Scattering::Off => Scattering::Off,
        };
        let surface = Surface::new(self.label(), specular, lobes, order, scattering).laid(lay);
        match scatter.and_then(|(name, model)| deposit(shop, name, model, &format!("scatter[{name:?}]"))) {
            Some(deposit) => surface.under(deposit, self.side == Some(Side::Back)),
            None => surface,
        }
    }
}
