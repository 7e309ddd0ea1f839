//! Checks of what is required.

use super::{Checker, Section};
use crate::error::Problem;

impl Checker<'_> {
    pub(super) fn requirements(&mut self) {
        let document = self.document;
        for (name, requirement) in document.system.requirements.iter() {
            let path = format!("requirements[{name:?}]");
            self.positive(requirement.limit.value(), &format!("{path}.limit"));
            let confidence = requirement.confidence;
            self.range((0.5..1.0).contains(&confidence), &format!("{path}.confidence"), "0.5 or more, below 1");
            match &requirement.detector {
                Some(detector) => self.refer(Section::Detectors, detector, &format!("{path}.detector")),
                None => {
                    let count = self.defined("detectors").len();
                    self.require(count == 1, &path, || {
                        let problem = Problem::error(format!("which of {count} detectors is this about?"));
                        problem.expecting("`detector:` with its name")
                    });
                }
            }
        }
    }
}
