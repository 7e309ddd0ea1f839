//! Checks of fields with a black patch.

use super::Checker;
use crate::error::Problem;

impl Checker<'_> {
    pub(super) fn glare(&mut self) {
        let document = self.document;
        for (name, glare) in document.system.glare.iter() {
            let path = format!("glare[{name:?}]");
            let [field, _] = glare.sources();
            self.extent(&field, &path);
            self.spectrum(&glare.spectrum, &format!("{path}.spectrum"));
            self.angle(glare.patch.0, (0.0, 180.0), &format!("{path}.patch"));
            self.angle(glare.field.0, (0.0, 180.0), &format!("{path}.field"));
            self.require(glare.patch.0 < glare.field.0 || glare.field.0 <= 0.0, &format!("{path}.patch"), || {
                Problem::error("the patch covers the field").expecting("`patch` below `field`")
            });
            self.watcher(&glare.detector, &path);
        }
    }
}
