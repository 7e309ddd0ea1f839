//! The built-in catalogue: glasses by maker, metals and other materials by author, from refractiveindex.info (CC0).
//!
//! | shelf | names | data |
//! |---|---|---|
//! | glass | `N-BK7`, or `SCHOTT:N-BK7` | all glasses of Schott, Ohara and Hoya: n relative to air, internal transmittance as k |
//! | metal | `Al`, or `Al:Rakic` | absolute n and k |
//! | material | `SiO2`, or `SiO2:Malitson` | crystals and films |
//!
//! A name alone means the only entry of that name or the one marked as the default: Al:Rakic, Ag:Yang, Au, Cr and Ni by Johnson;
//! SiO2:Malitson, MgF2:Dodge-o. Films depend on how they were made, so that the other materials with several entries have
//! no default.
//!
//! An entry is a page of refractiveindex.info without its texts, read by [`page`]; `catalog/README.md` tells what was
//! left out and how the files are made.

use super::catalogued::{Catalogued, Stated};
use super::page;
use crate::error::{Problem, did_you_mean};

/// Entries, each behind a line `# shelf name`.
const TEXTS: [&str; 2] = [include_str!("glass.txt"), include_str!("material.txt")];

/// What begins an entry.
const HEAD: &str = "# ";

/// A part of the catalogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shelf {
    Glass,
    Metal,
    Material,
}

/// An entry of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub shelf: Shelf,
    /// "SCHOTT:N-BK7", "Al:Rakic": unique on its shelf.
    pub name: &'static str,
    /// True if the short name means this entry among several.
    default: bool,
    text: &'static str,
}

impl Shelf {
    const ALL: [Shelf; 3] = [Shelf::Glass, Shelf::Metal, Shelf::Material];

    /// What the files call it.
    fn word(self) -> &'static str {
        match self {
            Shelf::Glass => "glass",
            Shelf::Metal => "metal",
            Shelf::Material => "material",
        }
    }

    /// What a system file calls it.
    fn option(self) -> &'static str {
        match self {
            Shelf::Glass => "Glass",
            Shelf::Metal => "Metal",
            Shelf::Material => "Material",
        }
    }

    /// All entries of the shelf.
    pub fn entries(self) -> impl Iterator<Item = Entry> {
        all().filter(move |entry| entry.shelf == self)
    }

    /// The entry of a name, with or without its maker or author.
    pub fn find(self, name: &str) -> Result<Entry, Problem> {
        if let Some(entry) = self.entries().find(|entry| entry.name == name) {
            return Ok(entry);
        }
        let same: Vec<Entry> = self.entries().filter(|entry| entry.short() == name).collect();
        match same[..] {
            [] => Err(self.unknown(name)),
            [only] => Ok(only),
            _ => same.iter().find(|entry| entry.default).copied().ok_or_else(|| {
                let names: Vec<String> = same.iter().map(|entry| format!("{:?}", entry.name)).collect();
                Problem::error(format!("{name:?} is in the catalogue {} times", same.len()))
                    .expecting(format!("one of {}", names.join(", ")))
            }),
        }
    }

    /// The medium of a name, with or without its maker or author.
    pub fn medium(self, name: &str) -> Result<Catalogued, Problem> {
        self.find(name)?.medium()
    }

    fn unknown(self, name: &str) -> Problem {
        let problem = Problem::error(format!("the built-in catalogue has no {} {name:?}", self.word()));
        let elsewhere = |shelf: &&Shelf| shelf.entries().any(|entry| [entry.name, entry.short()].contains(&name));
        if let Some(other) = Shelf::ALL.iter().find(elsewhere) {
            return problem.hinting(format!("it has a {}: `{}({name:?})`", other.word(), other.option()));
        }
        match did_you_mean(name, self.entries().flat_map(|entry| [entry.short(), entry.name])) {
            Some(close) => problem.hinting(format!("did you mean {close:?}?")),
            None => problem.expecting(self.content()),
        }
    }

    /// What the shelf holds, for who asks for something else.
    fn content(self) -> String {
        if self == Shelf::Glass {
            return "a glass of SCHOTT, OHARA or HOYA; a page or an AGF file gives any other".into();
        }
        let mut names: Vec<&str> = self.entries().map(|entry| entry.short()).collect();
        names.dedup();
        format!("one of {}; a page of refractiveindex.info gives any other", names.join(", "))
    }
}

impl Entry {
    /// The name without maker or author: "N-BK7", "Al".
    pub fn short(&self) -> &'static str {
        match (self.shelf, self.name.split_once(':')) {
            (Shelf::Glass, Some((_, glass))) => glass,
            (_, Some((material, _))) => material,
            (_, None) => self.name,
        }
    }

    /// The page behind the entry.
    pub fn page(&self) -> Result<Stated, Problem> {
        page::parse(self.text, self.name)
    }

    /// The medium it describes.
    pub fn medium(&self) -> Result<Catalogued, Problem> {
        Ok(self.page()?.medium)
    }
}

fn all() -> impl Iterator<Item = Entry> {
    let chunks = TEXTS.iter().flat_map(|text| text.split("\n# ").map(|chunk| chunk.trim_start_matches(HEAD)));
    chunks.filter_map(|chunk| {
        let (head, text) = chunk.split_once('\n')?;
        let mut words = head.split(' ');
        let (shelf, name) = (words.next()?, words.next()?);
        let shelf = Shelf::ALL.into_iter().find(|known| known.word() == shelf)?;
        Some(Entry { shelf, name, default: words.next() == Some("default"), text })
    })
}
