//! Checks of sources and targets.

use super::Checker;
use crate::error::Problem;
use crate::system::document::{Angular, Extent, Source, Spectrum, Target};
use crate::system::units::{Direction, Wavelength};

impl Checker<'_> {
    pub(super) fn sources(&mut self) {
        let document = self.document;
        let dark = self.defined("sources").is_empty() && self.defined("sweeps").is_empty();
        // What is warm shines by itself.
        let none = dark && document.system.thermal.is_none();
        self.require(!none, "sources", || {
            Problem::error("the system has no light source").expecting("`sources: {..}`")
        });
        for (name, source) in document.system.sources.iter() {
            let path = format!("sources[{name:?}]");
            self.power(source, &path);
            self.extent(source, &path);
            self.orientation(source, &path);
            self.angular(source, &path);
            self.spectrum(&source.spectrum, &format!("{path}.spectrum"));
        }
    }

    /// Either a flux or an irradiance, and an area for the latter.
    pub(super) fn power(&mut self, source: &Source, path: &str) {
        match (source.flux, source.irradiance) {
            (Some(flux), None) => self.positive(flux.0, &format!("{path}.flux")),
            (None, Some(irradiance)) => {
                self.positive(irradiance.0, &format!("{path}.irradiance"));
                let area = !matches!(source.extent, Extent::Point | Extent::Gaussian { .. });
                self.require(area, &format!("{path}.irradiance"), || {
                    Problem::error("this extent has no definite area to multiply with the irradiance")
                        .expecting("`flux`, or another extent")
                });
            }
            (Some(_), Some(_)) => self.push(
                &format!("{path}.irradiance"),
                Problem::error("both `flux` and `irradiance` are given").expecting("one of the two"),
            ),
            (None, None) => self.push(
                path,
                Problem::error("neither `flux` nor `irradiance` is given")
                    .expecting("`flux: \"1 W\"` or `irradiance: \"1361 W/m2\"`"),
            ),
        }
    }

    pub(super) fn extent(&mut self, source: &Source, path: &str) {
        let at = format!("{path}.extent");
        match &source.extent {
            Extent::Point => {}
            Extent::Disk { radius } => self.positive(radius.0, &format!("{at}.radius")),
            Extent::Annulus { inner, outer } => {
                self.not_negative(inner.0, &format!("{at}.inner"));
                self.positive(outer.0, &format!("{at}.outer"));
                self.require(inner.0 < outer.0 || outer.0 <= 0.0, &at, || {
                    Problem::error("this ring has no area").expecting("`inner` below `outer`")
                });
            }
            Extent::Polygon { radius, sides } => {
                self.positive(radius.0, &format!("{at}.radius"));
                self.range(*sides >= 3, &format!("{at}.sides"), "at least 3 corners");
            }
            Extent::Rectangle { width, height } => {
                self.positive(width.0, &format!("{at}.width"));
                self.positive(height.0, &format!("{at}.height"));
            }
            Extent::Gaussian { waist } => self.positive(waist.0, &format!("{at}.waist")),
            Extent::Node { name, side: _ } => self.not_empty(name, &format!("{at}.name"), "the name of the node"),
            Extent::Cover { nodes, margin } => self.cover(source, nodes, *margin, path),
        }
        let own = matches!(source.extent, Extent::Node { .. } | Extent::Cover { .. });
        self.require(source.at.is_none() || !own, &format!("{path}.at"), || {
            Problem::error("this extent takes its place from the nodes").expecting("no `at`")
        });
    }

    fn cover(&mut self, source: &Source, nodes: &[String], margin: f64, path: &str) {
        let at = format!("{path}.extent");
        self.require(!nodes.is_empty(), &format!("{at}.nodes"), || Problem::error("no nodes to cover"));
        for (index, node) in nodes.iter().enumerate() {
            self.not_empty(node, &format!("{at}.nodes[{index}]"), "the name of the node");
        }
        self.range(margin >= 1.0 && margin.is_finite(), &format!("{at}.margin"), "a factor of at least 1");
        let beam = matches!(source.angular, Angular::Collimated { .. }) || source.angular.is_sky();
        self.require(beam, &at, || {
            Problem::error("`Cover` lies across a beam, and this source has none")
                .expecting("`angular: Collimated(..)`, `AngularDiameter(..)` or `Ring(..)`")
        });
    }

    fn orientation(&mut self, source: &Source, path: &str) {
        let beam = match source.angular {
            Angular::Collimated { direction, .. } => direction,
            _ => None,
        };
        if let (Some(axis), Some(x)) = (source.axis.or(beam), source.x) {
            self.not_parallel(axis, x, &format!("{path}.x"), "axis");
        }
        if let (Some(axis), Some(beam)) = (source.axis, beam) {
            self.require(axis.0.dot(beam.0) > 0.0, &format!("{path}.axis"), || {
                Problem::error("the beam does not leave the front of its extent")
                    .expecting("an axis less than 90 deg from the direction")
            });
        }
    }

    pub(super) fn not_parallel(&mut self, axis: Direction, x: Direction, path: &str, name: &str) {
        // Below 1e-6 rad what is left of x after making it perpendicular is mostly rounding of the text.
        self.require(axis.0.cross(x.0).length() > 1e-6, path, || {
            Problem::error(format!("`x` is parallel to the {name}")).expecting("another direction")
        });
    }

    fn angular(&mut self, source: &Source, path: &str) {
        let at = format!("{path}.angular");
        match &source.angular {
            Angular::Collimated { .. } => self.collimated(source, &at),
            Angular::Cone { half_angle } => self.angle(half_angle.0, (0.0, 180.0), &format!("{at}.half_angle")),
            Angular::AngularDiameter(diameter) => self.angle(diameter.0, (0.0, 180.0), &at),
            Angular::Ring { inner, outer } => self.ring([inner.0, outer.0], &at),
            Angular::Gaussian { half_angle } => self.angle(half_angle.0, (0.0, 90.0), &format!("{at}.half_angle")),
            Angular::Lambertian | Angular::Isotropic => {}
        }
    }

    pub(super) fn ring(&mut self, [inner, outer]: [f64; 2], path: &str) {
        self.angle(inner, (0.0, 180.0), &format!("{path}.inner"));
        self.angle(outer, (0.0, 180.0), &format!("{path}.outer"));
        self.require(inner < outer || outer <= 0.0, path, || {
            Problem::error("this ring has no solid angle").expecting("`inner` below `outer`")
        });
    }

    fn collimated(&mut self, source: &Source, path: &str) {
        let Angular::Collimated { direction, aim_at, field } = &source.angular else { return };
        let given = usize::from(direction.is_some()) + usize::from(aim_at.is_some()) + usize::from(field.is_some());
        self.require(given == 1, path, || {
            let count = if given == 0 { "no direction is given" } else { "several directions are given" };
            Problem::error(count).expecting("one of `direction`, `aim_at` and `field`")
        });
        if let Some(target) = aim_at {
            let own = matches!(source.extent, Extent::Node { .. } | Extent::Cover { .. });
            self.require(!own, &format!("{path}.aim_at"), || {
                Problem::error("this extent has no centre to aim from").expecting("`direction` or `field`")
            });
            let centre = source.at.map_or(glam::DVec3::ZERO, |at| at.0);
            self.require(own || target.0 != centre, &format!("{path}.aim_at"), || {
                Problem::error("the source stands where it aims at").expecting("another point, or another `at`")
            });
        }
        if let Some((x, y)) = field {
            for (index, angle) in [x, y].into_iter().enumerate() {
                let holds = angle.0.abs() < std::f64::consts::FRAC_PI_2;
                self.range(holds, &format!("{path}.field[{index}]"), "a field angle between -90 deg and 90 deg");
            }
        }
    }

    pub(super) fn spectrum(&mut self, spectrum: &Spectrum, path: &str) {
        match spectrum {
            Spectrum::Line(wavelength) => self.wavelength(*wavelength, path),
            Spectrum::Lines(lines) => {
                for (at, (wavelength, weight)) in lines.iter().enumerate() {
                    self.wavelength(*wavelength, &format!("{path}[{at}][0]"));
                    self.not_negative(*weight, &format!("{path}[{at}][1]"));
                }
                self.some_weight(lines.iter().map(|(_, weight)| *weight), path);
            }
            Spectrum::Band { from, to } => self.band(*from, *to, path),
            Spectrum::Table { wavelength, weight } => {
                self.same_length([wavelength.len(), weight.len()], ["wavelength", "weight"], path);
                self.require(wavelength.len() != 1, path, || {
                    Problem::error("a table of one wavelength has no width")
                        .expecting("`Line(..)`, or more wavelengths")
                });
                self.wavelengths(wavelength, &format!("{path}.wavelength"));
                for (at, weight) in weight.iter().enumerate() {
                    self.not_negative(*weight, &format!("{path}.weight[{at}]"));
                }
                self.some_weight(weight.iter().copied(), path);
            }
            Spectrum::BlackBody { temperature, from, to } => {
                self.positive(temperature.0, &format!("{path}.temperature"));
                self.band(*from, *to, path);
            }
        }
    }

    fn band(&mut self, from: Wavelength, to: Wavelength, path: &str) {
        self.wavelength(from, &format!("{path}.from"));
        self.wavelength(to, &format!("{path}.to"));
        self.require(from.0 < to.0, path, || Problem::error("this band is empty").expecting("`from` below `to`"));
    }

    fn some_weight(&mut self, weights: impl Iterator<Item = f64>, path: &str) {
        let sum: f64 = weights.sum();
        self.require(sum != 0.0 && sum.is_finite() || sum.is_nan(), path, || {
            Problem::error("the weights of this spectrum do not have a finite sum above 0")
        });
    }

    pub(super) fn targets(&mut self) {
        let document = self.document;
        for (name, target) in document.system.targets.iter() {
            let path = format!("targets[{name:?}]");
            match target {
                Target::Node(glob) => self.not_empty(glob, &path, "the name of the node"),
                Target::Rectangle { at: _, normal, x, width, height } => {
                    self.positive(width.0, &format!("{path}.width"));
                    self.positive(height.0, &format!("{path}.height"));
                    if let Some(x) = x {
                        self.not_parallel(*normal, *x, &format!("{path}.x"), "normal");
                    }
                }
                Target::Disk { at: _, normal: _, radius } => self.positive(radius.0, &format!("{path}.radius")),
            }
        }
    }
}
