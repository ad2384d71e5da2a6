//! Trust in files outside of the graph's folder.

use sabi_files::TrustedPaths;

use super::Session;

impl Session {
    /// Allows the graph to open the files that it names below these paths, too.
    pub fn trust(&mut self, trusted: &TrustedPaths) {
        let before = self.open.trusted.clone();
        self.open.trusted = before.clone().with(trusted);
        if self.open.trusted != before {
            self.open.strokes.trust(trusted);
            self.changed_otherwise();
        }
    }
}
