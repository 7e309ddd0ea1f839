//! Checks of temperatures.

use super::Checker;
use crate::error::Problem;
use crate::system::document::Spectrum;

impl Checker<'_> {
    pub(super) fn thermal(&mut self) {
        let document = self.document;
        let Some(thermal) = &document.system.thermal else { return };
        self.spectrum(&thermal.band, "thermal.band");
        self.require(matches!(thermal.band, Spectrum::Band { .. }), "thermal.band", || {
            Problem::error("what is warm has the spectrum of its temperature").expecting("`Band(from: .., to: ..)`")
        });
        let mut hottest = 0.0_f64;
        for (at, (_, temperature)) in thermal.temperatures.iter().enumerate() {
            let path = format!("thermal.temperatures[{at}]");
            self.range(temperature.0 >= 0.0 && temperature.0.is_finite(), &format!("{path}[1]"), "0 K or more");
            hottest = hottest.max(temperature.0);
        }
        let judged = thermal.temperatures.iter().all(|(_, temperature)| temperature.0 >= 0.0);
        self.require(hottest > 0.0 || !judged, "thermal.temperatures", || {
            Problem::error("nothing is warm").expecting("a node with a temperature above 0 K")
        });
    }
}
