//! The variant that is shown and edited.

use std::collections::BTreeMap;

use sabi_graph::{Edit, Value};

use crate::navigation;
use crate::open_document::OpenDocument;

/// Returns the variant with whose values the shown graph is evaluated, and that edits of exposed knobs change: the variant of
/// the preview, or inside a group the variant of the entered instance. `None` means the graph's own values.
pub fn name(document: &OpenDocument) -> Option<&str> {
    chosen(document).filter(|name| document.graph().variants().contains_key(*name))
}

/// Returns the name of the shown variant in the document, even if no variant with that name exists.
pub(crate) fn chosen(document: &OpenDocument) -> Option<&str> {
    match navigation::entered_instance(document) {
        None => document.contents().preview.as_ref()?.variant.as_deref(),
        Some((body, id)) => {
            let instance = document.graph_of(&body)?.node(id.as_str())?;
            instance.params.get("variant")?.as_text()
        }
    }
}

/// Values of the shown variant, with its name.
pub(crate) fn values(document: &OpenDocument) -> Option<(&str, &BTreeMap<String, Value>)> {
    let name = name(document)?;
    Some((name, document.graph().variants().get(name)?))
}

/// Edit that sets the values of a variant; `None` removes it.
pub(crate) fn setting(document: &OpenDocument, name: &str, values: Option<BTreeMap<String, Value>>) -> Edit {
    Edit::SetVariant {
        body: document.body(),
        name: name.to_owned(),
        values,
    }
}
