//! From a document to its canonical text.
use crate::Document;
pub(crate) fn document(document: &Document) -> String {
    todo!()
}
