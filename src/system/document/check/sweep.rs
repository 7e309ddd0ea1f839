//! Checks of sweeps.

use super::{Checker, Section};
use crate::error::Problem;
use crate::system::document::sweep::MOST_ANGLES;
use crate::system::document::{Angles, Sweep, degrees};
use crate::system::units::Direction;
use glam::DVec3;
use std::f64::consts::PI;

/// Most directions of one sweep: each is a source, and every batch has a ray of each.
const MOST_DIRECTIONS: usize = 4096;

impl<'a> Checker<'a> {
    pub(super) fn sweeps(&mut self) {
        let document = self.document;
        for (name, sweep) in document.system.sweeps.iter() {
            let path = format!("sweeps[{name:?}]");
            // What holds of one direction holds of all: the source on the axis stands for them.
            let source = sweep.source(0.0, 0.0);
            self.power(&source, &path);
            self.extent(&source, &path);
            self.spectrum(&source.spectrum, &format!("{path}.spectrum"));
            if let Some(diameter) = sweep.diameter {
                self.angle(diameter.0, (0.0, 180.0), &format!("{path}.diameter"));
            }
            self.angles(&sweep.angles, &format!("{path}.angles"));
            self.azimuths(sweep, &path);
            self.frame(sweep, &path);
            self.watcher(&sweep.detector, &path);
        }
    }

    fn angles(&mut self, angles: &Angles, path: &str) {
        if let Angles::Linear { count, .. } | Angles::Log { count, .. } = angles {
            let expected = format!("2 to {MOST_ANGLES}");
            self.range((2..=MOST_ANGLES).contains(count), &format!("{path}.count"), &expected);
        }
        if let Angles::Log { from, .. } = angles {
            self.positive(from.0, &format!("{path}.from"));
        }
        let values = angles.values();
        // One part in 1e12 for the conversion from degrees.
        let inside = values.iter().all(|angle| (0.0..=PI * (1.0 + 1e-12)).contains(angle));
        self.require(inside, path, || {
            Problem::error("an angle is out of range").expecting("angles from the boresight, 0 deg to 180 deg")
        });
        let list = matches!(angles, Angles::List(list) if list.is_empty());
        self.require(!list, path, || Problem::error("the list is empty"));
        self.require(!inside || values.windows(2).all(|pair| pair[0] < pair[1]), path, || {
            Problem::error("the angles do not rise").expecting("rising angles, each given once")
        });
    }

    fn azimuths(&mut self, sweep: &Sweep, path: &str) {
        let azimuths = sweep.azimuths();
        let at = format!("{path}.azimuths");
        self.require(!azimuths.is_empty(), &at, || Problem::error("the list is empty"));
        self.require(azimuths.windows(2).all(|pair| pair[0] < pair[1]), &at, || {
            Problem::error("the azimuths do not rise").expecting("rising azimuths, each given once")
        });
        let round = azimuths.first().zip(azimuths.last()).is_some_and(|(a, b)| b - a > 2.0 * PI * (1.0 - 1e-12));
        self.require(!round, &at, || {
            Problem::error("the azimuths go round more than once").expecting("less than 360 deg from first to last")
        });
        let directions = azimuths.len() * sweep.angles.values().len();
        self.require(directions <= MOST_DIRECTIONS, path, || {
            Problem::error(format!("this sweep has {directions} directions"))
                .expecting(format!("at most {MOST_DIRECTIONS}"))
        });
    }

    fn frame(&mut self, sweep: &Sweep, path: &str) {
        let up = sweep.up.unwrap_or(Direction(DVec3::Y));
        // Below 1e-6 rad what is left of `up` after making it perpendicular is mostly rounding of the text.
        self.require(sweep.boresight().cross(up.0).length() > 1e-6, &format!("{path}.up"), || {
            Problem::error("`up` is parallel to the boresight").expecting("another direction")
        });
        if let (Some(axis), Some(x)) = (sweep.axis, sweep.x) {
            self.not_parallel(axis, x, &format!("{path}.x"), "axis");
        }
        let Some(axis) = sweep.axis else { return };
        self.require(sweep.diameter.is_none(), &format!("{path}.axis"), || {
            Problem::error("the extent of a source with a diameter lies across its beam").expecting("no `axis`")
        });
        let azimuths = sweep.azimuths();
        let beams = sweep.angles.values().into_iter().flat_map(|theta| azimuths.iter().map(move |phi| (theta, *phi)));
        let behind = beams.map(|(theta, phi)| (theta, sweep.direction(theta, phi))).find(|b| b.1.dot(axis.0) <= 1e-9);
        if let Some((theta, _)) = behind {
            let problem =
                Problem::error(format!("at {} deg the beam does not leave the front of its extent", degrees(theta)));
            self.push(&format!("{path}.axis"), problem.expecting("angles below 90 deg from the axis, or no `axis`"));
        }
    }

    /// The detector whose mean irradiance is asked for: named, or the only one.
    pub(super) fn watcher(&mut self, detector: &'a Option<String>, path: &str) {
        match detector {
            Some(name) => self.refer(Section::Detectors, name, &format!("{path}.detector")),
            None => {
                let names = self.defined("detectors");
                self.require(names.len() <= 1, path, || {
                    let names: Vec<String> = names.iter().take(12).map(|name| format!("{name:?}")).collect();
                    Problem::error("whose mean irradiance is asked for?")
                        .expecting(format!("`detector:` with one of {}", names.join(", ")))
                });
                self.require(!names.is_empty(), path, || {
                    Problem::error("a detector is needed here").expecting("`detectors: {..}`")
                });
            }
        }
    }
}
