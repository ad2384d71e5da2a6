//! From text to a document.
use crate::{Document, FileError};
pub(crate) fn document(text: &str) -> Result<Document, FileError> {
    todo!()
}
