//! Checks of detectors.

use super::Checker;
use crate::error::Problem;
use crate::system::document::{Counts, Detector, Efficiency, Quantity, Receiver, Region};

/// Most bins of one map: 8 arrays of doubles of this size fill 4 GiB.
const MOST_BINS: u64 = 1 << 26;

impl Checker<'_> {
    pub(super) fn detectors(&mut self) {
        let document = self.document;
        let none = self.defined("detectors").is_empty();
        self.require(!none, "detectors", || {
            Problem::warning("the system has no detector: only the ledger of the flux will be reported")
        });
        for (name, detector) in document.system.detectors.iter() {
            let path = format!("detectors[{name:?}]");
            self.receiver(&detector.on, &format!("{path}.on"));
            self.map(detector, &path);
            self.counts(detector, &path);
            self.regions(detector, &path);
        }
    }

    fn receiver(&mut self, receiver: &Receiver, path: &str) {
        match receiver {
            Receiver::Node(glob) => self.not_empty(glob, path, "the name of the node"),
            Receiver::Rectangle { at: _, normal, x, width, height } => {
                self.positive(width.0, &format!("{path}.width"));
                self.positive(height.0, &format!("{path}.height"));
                if let Some(x) = x {
                    self.not_parallel(*normal, *x, &format!("{path}.x"), "normal");
                }
            }
            Receiver::Disk { at: _, normal: _, radius } => self.positive(radius.0, &format!("{path}.radius")),
            Receiver::FarField { axis: _ } => {}
        }
    }

    fn counts(&mut self, detector: &Detector, path: &str) {
        if let Counts::Electrons { qe } = &detector.counts {
            self.efficiency(qe, &format!("{path}.counts.qe"), f64::INFINITY);
        }
        if let Some(filter) = &detector.filter {
            self.efficiency(filter, &format!("{path}.filter"), 1.0);
        }
    }

    /// Shares from 0 to `most` at wavelengths that rise.
    fn efficiency(&mut self, efficiency: &Efficiency, path: &str, most: f64) {
        let rows = &efficiency.0;
        let rises = !rows.is_empty() && rows.windows(2).all(|pair| pair[0].0 < pair[1].0);
        self.require(rises, path, || {
            Problem::error("the wavelengths do not rise").expecting("at least one row, in order")
        });
        let shares = rows.iter().all(|(_, share)| share.is_finite() && (0.0..=most).contains(share));
        let expected = if most.is_finite() { "shares from 0 to 1" } else { "electrons per photon, from 0" };
        self.range(shares, path, expected);
    }

    fn regions(&mut self, detector: &Detector, path: &str) {
        let flat = detector.quantity == Quantity::Irradiance || detector.regions.is_empty();
        self.require(flat, &format!("{path}.regions"), || {
            Problem::error("regions lie on a plane, and this detector maps directions")
                .expecting("`quantity: Irradiance`")
        });
        for (at, (name, region)) in detector.regions.iter().enumerate() {
            let path = format!("{path}.regions[{at}]");
            let known = detector.regions[..at].iter().any(|(other, _)| other == name);
            self.require(!known, &path, || Problem::error(format!("the region {name:?} is there already")));
            match region {
                Region::Disk { at: _, radius } => self.positive(radius.0, &format!("{path}.radius")),
                Region::Annulus { at: _, inner, outer } => {
                    self.not_negative(inner.0, &format!("{path}.inner"));
                    self.require(inner.0 < outer.0, &path, || {
                        Problem::error("this annulus has no area").expecting("`inner` below `outer`")
                    });
                }
                Region::Rectangle { at: _, width, height } => {
                    self.positive(width.0, &format!("{path}.width"));
                    self.positive(height.0, &format!("{path}.height"));
                }
            }
        }
    }

    fn map(&mut self, detector: &Detector, path: &str) {
        let (columns, rows) = detector.pixels.unwrap_or((1, 1));
        let bins = u64::from(columns) * u64::from(rows);
        self.range((1..=MOST_BINS).contains(&bins), &format!("{path}.pixels"), "at least (1, 1), at most 2^26 pixels");
        let far = matches!(detector.on, Receiver::FarField { .. });
        self.require(!far || detector.quantity == Quantity::Intensity, &format!("{path}.quantity"), || {
            Problem::error("the far field has no area, so no irradiance").expecting("`quantity: Intensity`")
        });
        let directions = detector.quantity == Quantity::Intensity;
        self.require(detector.bins.is_none() || directions, &format!("{path}.bins"), || {
            Problem::error("`bins` sorts directions, and this detector maps positions")
                .expecting("`quantity: Intensity`")
        });
    }
}
