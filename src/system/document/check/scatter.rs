//! Checks of scatter models.

use super::{Checker, ROUNDING};
use crate::bsdf::finish;
use crate::error::Problem;
use crate::system::document::{FacetEnergy, Roughness, Scatter, ScatterSide};
use crate::system::units::{Frequency, PowerDensity};

impl Checker<'_> {
    pub(super) fn scatter(&mut self) {
        for (name, scatter) in self.document.system.scatter.iter() {
            let path = format!("scatter[{name:?}]");
            self.scatter_model(scatter, &path);
            let sum = lambertian(scatter);
            self.require(!matches!(scatter, Scatter::Sum(_)) || sum <= 1.0 + ROUNDING, &path, || {
                Problem::error(format!("the Lambertian parts add up to {sum}: more light leaves than arrives"))
                    .expecting("a sum of at most 1")
            });
        }
    }

    fn scatter_model(&mut self, scatter: &Scatter, path: &str) {
        match scatter {
            Scatter::Lambertian { reflectance, transmittance } => {
                self.shares(&[("reflectance", *reflectance), ("transmittance", *transmittance)], path);
            }
            Scatter::ABg { a, b, g, side: _ } => {
                self.not_negative(*a, &format!("{path}.a"));
                self.positive(*b, &format!("{path}.b"));
                self.not_negative(*g, &format!("{path}.g"));
            }
            Scatter::HarveyShack { b0, l, s, side: _ } => {
                self.not_negative(*b0, &format!("{path}.b0"));
                self.positive(*l, &format!("{path}.l"));
                self.range(*s <= 0.0 && s.is_finite(), &format!("{path}.s"), "a slope of at most 0: scatter falls off");
            }
            Scatter::Gaussian { a, sigma, side: _ } => {
                self.not_negative(*a, &format!("{path}.a"));
                self.positive(*sigma, &format!("{path}.sigma"));
            }
            Scatter::CosinePower { a, n, about: _ } => {
                self.not_negative(*a, &format!("{path}.a"));
                self.not_negative(*n, &format!("{path}.n"));
            }
            Scatter::OrenNayar { reflectance, sigma } => {
                self.fraction(*reflectance, &format!("{path}.reflectance"));
                self.range((0.0..=1.5).contains(&sigma.0), &format!("{path}.sigma"), "an angle from 0 to 1.5 rad");
            }
            Scatter::KCorrelation { rms, b, s, side: _ } => {
                self.positive(b.0, &format!("{path}.b"));
                self.positive(*s, &format!("{path}.s"));
                self.roughness(rms, *s, path);
            }
            Scatter::Psd { frequency, density, side: _ } => self.spectrum_of_heights(frequency, density, path),
            Scatter::Microfacet { alpha, side, energy, .. } => {
                self.range((0.001..=1.0).contains(alpha), &format!("{path}.alpha"), "a roughness from 0.001 to 1");
                let lost = *energy == FacetEnergy::Compensated && *side == ScatterSide::Transmit;
                self.require(!lost, &format!("{path}.energy"), || {
                    Problem::error("what passes several facets is not modelled")
                        .expecting("`Compensated` on reflection only")
                });
            }
            Scatter::Table { file, scale, unmeasured: _ } => {
                self.file(file, path);
                self.not_negative(*scale, &format!("{path}.scale"));
            }
            Scatter::Finish(name) => {
                if let Err(problem) = finish::find(name) {
                    self.push(path, problem);
                }
            }
            Scatter::Klems { file, scale, band } => {
                self.file(file, path);
                self.not_negative(*scale, &format!("{path}.scale"));
                self.not_empty(band, &format!("{path}.band"), "the name of the band");
            }
            Scatter::Contamination { .. } => self.contamination(scatter, path),
            Scatter::Sum(parts) => {
                self.require(!parts.is_empty(), path, || Problem::error("this sum has no parts"));
                let layers = parts.iter().filter(|part| part.contamination().is_some()).count();
                self.require(layers < 2, path, || {
                    Problem::error("particles lie on it twice").expecting("one `Contamination`, of all particles")
                });
                for (at, part) in parts.iter().enumerate() {
                    self.scatter_model(part, &format!("{path}[{at}]"));
                }
            }
        }
    }

    fn contamination(&mut self, scatter: &Scatter, path: &str) {
        let Scatter::Contamination { level, slope, smallest, largest, bins, n, k } = scatter else { return };
        self.range(*level >= 1.0 && level.is_finite(), &format!("{path}.level"), "a level of at least 1");
        self.positive(*slope, &format!("{path}.slope"));
        let sizes = (1e-8..1e-2).contains(&smallest.0) && smallest.0 < largest.0 && largest.0 <= 1e-3;
        self.range(sizes, &format!("{path}.smallest"), "diameters from 10 nm to 1 mm, the smallest below the largest");
        for (at, (diameter, number)) in bins.iter().flatten().enumerate() {
            let good = (1e-8..=1e-3).contains(&diameter.0);
            self.range(good, &format!("{path}.bins[{at}][0]"), "a diameter from 10 nm to 1 mm");
            self.not_negative(*number, &format!("{path}.bins[{at}][1]"));
        }
        self.positive(*n, &format!("{path}.n"));
        self.not_negative(*k, &format!("{path}.k"));
    }

    fn roughness(&mut self, roughness: &Roughness, slope: f64, path: &str) {
        match roughness {
            Roughness::Total(rms) => {
                self.not_negative(rms.0, &format!("{path}.rms"));
                self.require(slope > 2.0 || slope <= 0.0, &format!("{path}.rms"), || {
                    Problem::error(format!("with s = {slope} the rms height over all frequencies is infinite"))
                        .expecting("s above 2, or `Band(rms:, from:, to:)`")
                });
            }
            Roughness::Band { rms, from, to } => {
                self.not_negative(rms.0, &format!("{path}.rms.rms"));
                self.not_negative(from.0, &format!("{path}.rms.from"));
                self.require(from.0 < to.0, &format!("{path}.rms"), || {
                    Problem::error("this band is empty").expecting("`from` below `to`")
                });
            }
        }
    }

    fn spectrum_of_heights(&mut self, frequency: &[Frequency], density: &[PowerDensity], path: &str) {
        self.same_length([frequency.len(), density.len()], ["frequency", "density"], path);
        self.require(frequency.len() != 1, &format!("{path}.frequency"), || {
            Problem::error("a spectrum of one frequency has no slope").expecting("two or more")
        });
        for (at, frequency) in frequency.iter().enumerate() {
            self.positive(frequency.0, &format!("{path}.frequency[{at}]"));
        }
        for (at, density) in density.iter().enumerate() {
            self.positive(density.0, &format!("{path}.density[{at}]"));
        }
        if let Some(at) = frequency.windows(2).position(|pair| pair[1].0 <= pair[0].0) {
            let problem = Problem::error("the frequencies do not increase here");
            self.push(
                &format!("{path}.frequency[{}]", at + 1),
                problem.expecting("increasing frequencies, each given once"),
            );
        }
    }
}

/// Reflectance and transmittance of the Lambertian parts together, dimensionless.
fn lambertian(scatter: &Scatter) -> f64 {
    match scatter {
        Scatter::Lambertian { reflectance, transmittance } => reflectance + transmittance,
        Scatter::Sum(parts) => parts.iter().map(lambertian).sum(),
        _ => 0.0,
    }
}
