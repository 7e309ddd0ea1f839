//! Checks of media and surfaces.

use super::{Checker, Section};
use crate::error::Problem;
use crate::medium::catalog::Shelf;
use crate::system::document::{ExtrasValue, Finish, Medium, Predicate, Scattering, Selector, Specular, Surface};
use std::path::Path;

/// Most targets that a surface may aim at.
const MOST_AIMS: usize = 4;

impl<'a> Checker<'a> {
    pub(super) fn media(&mut self) {
        let document = self.document;
        for (name, medium) in document.system.media.iter() {
            let path = format!("media[{name:?}]");
            self.require(name != "vacuum", &path, || {
                Problem::error("\"vacuum\" is always there and cannot be defined").expecting("another name")
            });
            self.medium(medium, &path);
        }
        self.refer(Section::Media, &document.system.ambient, "ambient");
    }

    pub(super) fn medium(&mut self, medium: &Medium, path: &str) {
        match medium {
            Medium::Constant { n, k, absorption } => {
                self.positive(*n, &format!("{path}.n"));
                self.not_negative(k.unwrap_or(0.0), &format!("{path}.k"));
                self.not_negative(absorption.map_or(0.0, |a| a.0), &format!("{path}.absorption"));
                self.one_loss(k.is_some() && absorption.is_some(), path);
            }
            Medium::Sellmeier { b, c } => {
                self.same_length([b.len(), c.len()], ["b", "c"], path);
                b.iter().enumerate().for_each(|(at, b)| self.finite(*b, &format!("{path}.b[{at}]")));
            }
            Medium::Tabulated { wavelength, n, k, absorption } => {
                self.same_length([wavelength.len(), n.len()], ["wavelength", "n"], path);
                self.wavelengths(wavelength, &format!("{path}.wavelength"));
                n.iter().enumerate().for_each(|(at, n)| self.positive(*n, &format!("{path}.n[{at}]")));
                if let Some(k) = k {
                    self.same_length([wavelength.len(), k.len()], ["wavelength", "k"], path);
                    k.iter().enumerate().for_each(|(at, k)| self.not_negative(*k, &format!("{path}.k[{at}]")));
                }
                if let Some(alpha) = absorption {
                    self.same_length([wavelength.len(), alpha.len()], ["wavelength", "absorption"], path);
                    let place = |at| format!("{path}.absorption[{at}]");
                    alpha.iter().enumerate().for_each(|(at, alpha)| self.not_negative(alpha.0, &place(at)));
                }
                self.one_loss(k.is_some() && absorption.is_some(), path);
            }
            Medium::Air { temperature, pressure } => {
                let [kelvin, pascal] = [temperature.0, pressure.0];
                self.range((233.0..=373.0).contains(&kelvin), &format!("{path}.temperature"), "233 K to 373 K");
                self.range((0.0..=2e5).contains(&pascal), &format!("{path}.pressure"), "0 to 200 kPa");
            }
            Medium::Glass(name) => self.catalogued(Shelf::Glass, name, path),
            Medium::Metal(name) => self.catalogued(Shelf::Metal, name, path),
            Medium::Material(name) => self.catalogued(Shelf::Material, name, path),
            Medium::RefractiveIndexInfo { file } => self.file(file, path),
            Medium::Agf { file, glass } => {
                self.file(file, path);
                self.not_empty(glass, &format!("{path}.glass"), "the name of the glass");
            }
            Medium::Turbid { host, scatter } => {
                self.medium(host, &format!("{path}.host"));
                self.bulk(scatter, &format!("{path}.scatter"));
            }
        }
    }

    fn one_loss(&mut self, both: bool, path: &str) {
        self.require(!both, path, || Problem::error("both `k` and `absorption` are given").expecting("one of the two"));
    }

    /// A name of the built-in catalogue.
    fn catalogued(&mut self, shelf: Shelf, name: &str, path: &str) {
        if let Err(problem) = shelf.find(name) {
            self.push(path, problem);
        }
    }

    pub(super) fn file(&mut self, file: &Path, path: &str) {
        self.not_empty(&file.display().to_string(), &format!("{path}.file"), "the name of the file");
    }

    pub(super) fn surfaces(&mut self) {
        let document = self.document;
        for (at, surface) in document.indices.surfaces.iter().zip(&document.system.surfaces) {
            let path = format!("surfaces[{at}]");
            self.selector(&surface.on, &format!("{path}.on"));
            if !document.indices.outlines.contains(at) {
                self.surface(surface, &path);
            }
        }
        if let Some(finish) = &document.system.default {
            self.finish(finish, "default");
        }
    }

    fn finish(&mut self, finish: &'a Finish, path: &str) {
        self.specular(finish.specular, finish.coating.as_deref(), path);
        self.aim(finish.aim.as_deref(), path);
        self.scattering(finish.scatter.as_deref(), finish.scattering, path);
    }

    fn surface(&mut self, surface: &'a Surface, path: &str) {
        self.specular(surface.specular, surface.coating.as_deref(), path);
        self.scattering(surface.scatter.as_deref(), surface.scattering, path);
        self.aim(surface.aim.as_deref(), path);
        if let Some(medium) = &surface.medium {
            self.refer(Section::Media, medium, &format!("{path}.medium"));
        }
        if let Some((front, back)) = &surface.between {
            self.refer(Section::Media, front, &format!("{path}.between[0]"));
            self.refer(Section::Media, back, &format!("{path}.between[1]"));
            self.require(surface.medium.is_none(), &format!("{path}.between"), || {
                Problem::error("both `medium` and `between` are given")
                    .expecting("`medium` for a closed solid, or `between` for an open sheet")
            });
        }
        self.require(*surface != Surface::new(surface.on.clone()), path, || {
            Problem::warning("this entry says nothing about the surfaces it selects")
        });
    }

    fn aim(&mut self, aim: Option<&'a [String]>, path: &str) {
        let names = aim.unwrap_or_default();
        names.iter().enumerate().for_each(|(i, name)| self.refer(Section::Targets, name, &format!("{path}.aim[{i}]")));
        self.range(names.len() <= MOST_AIMS, &format!("{path}.aim"), "at most 4 targets");
    }

    fn specular(&mut self, specular: Option<Specular>, coating: Option<&'a str>, path: &str) {
        if let Some(coating) = specular.and_then(Specular::coating) {
            self.coating(&coating, &format!("{path}.specular"));
        }
        if let Some(name) = coating {
            self.refer(Section::Coatings, name, &format!("{path}.coating"));
        }
        self.require(specular.is_none() || coating.is_none(), &format!("{path}.coating"), || {
            Problem::error("both `specular` and `coating` are given").expecting("one of the two")
        });
    }

    fn scattering(&mut self, scatter: Option<&'a str>, scattering: Option<Scattering>, path: &str) {
        if let Some(name) = scatter {
            self.refer(Section::Scatter, name, &format!("{path}.scatter"));
        }
        let contradiction = scatter.is_some() && scattering == Some(Scattering::Off);
        self.require(!contradiction, &format!("{path}.scattering"), || {
            Problem::warning("this entry gives a scatter model and turns scatter off")
        });
    }

    fn selector(&mut self, selector: &Selector, path: &str) {
        match selector {
            Selector::Tag(glob) => self.not_empty(glob, path, "the name of the material"),
            Selector::Node(glob) => self.not_empty(glob, path, "the name of the node"),
            Selector::Extras { key, value } => {
                self.not_empty(key, &format!("{path}.key"), "the key");
                if let ExtrasValue::Number(number) = value {
                    self.finite(*number, &format!("{path}.value"));
                }
            }
            Selector::Faces { of, predicate } => {
                self.not_empty(of, &format!("{path}.of"), "the name of the node");
                self.predicate(predicate, &format!("{path}.where"));
            }
            Selector::Any(parts) => {
                self.require(!parts.is_empty(), path, || Problem::error("this list of selectors is empty"));
                for (at, part) in parts.iter().enumerate() {
                    self.selector(part, &format!("{path}[{at}]"));
                }
            }
        }
    }

    fn predicate(&mut self, predicate: &Predicate, path: &str) {
        match predicate {
            Predicate::Radial { within, .. } => self.angle(within.0, (0.0, 90.0), &format!("{path}.within")),
            Predicate::Normal { within, .. } => self.angle(within.0, (0.0, 180.0), &format!("{path}.within")),
            Predicate::Box { min, max } => self.require(min.0.cmplt(max.0).all(), path, || {
                Problem::error("this box has no volume").expecting("every coordinate of `min` below that of `max`")
            }),
            Predicate::Nearest { smooth, .. } => self.angle(smooth.0, (0.0, 180.0), &format!("{path}.smooth")),
            Predicate::All(parts) => {
                self.require(!parts.is_empty(), path, || Problem::error("this list of predicates is empty"));
                for (at, part) in parts.iter().enumerate() {
                    self.predicate(part, &format!("{path}[{at}]"));
                }
            }
        }
    }
}
