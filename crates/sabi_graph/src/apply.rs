//! Making edits.
use crate::{Document, Edit, EditError};
impl Document {
    /// Makes a change and gives its exact inverse.
    ///
    /// # Errors
    /// The change was refused; the document is as it was.
    pub fn apply(&mut self, edit: Edit) -> Result<Edit, EditError> {
        todo!()
    }
}
