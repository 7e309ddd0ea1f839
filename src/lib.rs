//! straylight: a compiler from a written optical system to numbers with error bars.
//!
//! ```text
//! System  ──compile──▶  Scene  ──trace──▶  Tally  ──report──▶  Report
//! (RON + glTF, as written)   (ids, f64, SI)    (sums per batch)      (maps, tables, HTML)
//! ```
//!
//! Four verbs:
//!
//! | verb | call | gives |
//! |---|---|---|
//! | read | [`Document::read`](system::document::Document::read) | the system as written, or every problem in it with file, line and column |
//! | compile | [`compile`](system::compile::compile) | a [`Scene`](scene::Scene) and [`Settings`](settings::Settings): ids and SI units |
//! | trace | [`transport::run`], [`transport::summary::results`] | [`Results`](tally::results::Results): every number with its error |
//! | report | [`report::write`], [`report::text`] | a folder of maps, tables and one page; a text for the terminal |
//!
//! ```ignore
//! let document = Document::read(Path::new("systems/slab/system.ron"))?;
//! let Compiled { scene, settings, inputs, .. } = compile(&document)?;
//! let counts = transport::run::<1>(&scene, &settings, &AtomicBool::new(false), &|_| ());
//! let results = summary::results(&scene, &settings, &counts, 0, inputs, Vec::new());
//! ```
//!
//! (`tests/systems.rs` holds the same as a function that is compiled and run.) The library never prints, never exits and does
//! not panic on input; what fails is an [`Error`](error::Error) with its place and its remedy.
//!
//! # Layers
//!
//! A module uses what stands below it; modules of one row do not know each other. `tests/layers.rs` holds it.
//!
//! ```text
//!                           report
//!                    maps, tables, page, messages
//! ─────────────────────────────────────────────────────────────
//!                           study
//!                    comparisons of variants, sensitivities, field sweeps, glare, ghosts
//! ─────────────────────────────────────────────────────────────
//!            system                      transport
//!   document, glTF, compiler    walk, interaction, path table
//! ─────────────────────────────────────────────────────────────
//!                           scene
//! ─────────────────────────────────────────────────────────────
//!                 surface     tally     filter
//! ─────────────────────────────────────────────────────────────
//!      coating   bsdf   packet   source   detector   aim
//! ─────────────────────────────────────────────────────────────
//!                           medium
//! ─────────────────────────────────────────────────────────────
//!                      film     import
//! ─────────────────────────────────────────────────────────────
//!            geometry     optics     prescription
//! ─────────────────────────────────────────────────────────────
//!                 error    math    settings
//! ```
//!
//! The nouns that models are written against: [`Incidence`](optics::Incidence) (one arrival at a surface),
//! [`Coating`](coating::Coating), [`Bsdf`](bsdf::Bsdf), [`Medium`](medium::Medium), [`Grid`](detector::Grid). One model is one file;
//! it opens with its equation, its units, its source and what it leaves out.
//!
//! # Units
//!
//! SI throughout: m, W, rad, sr, K; vacuum wavelengths in m; f64. Units are read once, where text enters ([`system::units`]).

// Indented blocks in the documentation are formulas, not code.
#![allow(rustdoc::invalid_rust_codeblocks)]

pub mod aim;
pub mod bsdf;
pub mod coating;
pub mod detector;
pub mod error;
/// An air film between faces that lie on each other.
pub mod film;
pub mod filter;
pub mod geometry;
pub mod import;
pub mod math;
pub mod medium;
pub mod optics;
pub mod packet;
pub mod prescription;
pub mod report;
pub mod scene;
pub mod settings;
pub mod source;
pub mod study;
pub mod surface;
pub mod system;
pub mod tally;
pub mod transport;
