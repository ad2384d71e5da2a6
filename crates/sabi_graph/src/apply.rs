//! Applies edits and gives their exact inverses.

mod exposed_knobs;
mod groups;
mod no_effect;
mod nodes;

use std::collections::BTreeMap;

use crate::document::GroupInput;
use crate::problem::{Problem, hint, quoted};
use crate::validate;
use crate::{Body, Document, Edit, EditError, Graph, OutputRef, Value};

/// Graph, inputs and outputs of a body.
type PartsMut<'a> = (
    &'a mut Graph,
    &'a mut BTreeMap<String, GroupInput>,
    &'a mut BTreeMap<String, OutputRef>,
);

impl Document {
    /// Applies a change and returns its exact inverse. Applying the inverse next restores the document byte for byte.
    ///
    /// # Errors
    /// The change was refused; the document is as it was.
    pub fn apply(&mut self, edit: Edit) -> Result<Edit, EditError> {
        match edit {
            Edit::AddNode { body, id, node, inputs } => self.add_node(body, id, node, inputs),
            Edit::RemoveNode { body, id } => self.remove_node(body, id),
            Edit::SetParam {
                body,
                node,
                param,
                value,
            } => self.set_param(body, node, param, value),
            Edit::Connect {
                body,
                node,
                input,
                from,
            } => self.connect(body, node, input, from),
            Edit::Disconnect { body, node, input } => self.disconnect(body, node, input),
            Edit::Move { body, node, pos } => self.move_node(body, node, pos),
            Edit::SetMuted { body, node, muted } => self.set_muted(body, node, muted),
            Edit::SetDisplay { body, node, display } => self.set_display(body, node, display),
            Edit::SetLabel { body, node, label } => self.set_label(body, node, label),
            Edit::AddFrame { body, id, frame } => self.add_frame(body, id, frame),
            Edit::RemoveFrame { body, id } => self.remove_frame(body, id),
            Edit::SetNote { body, id, note } => self.set_note(body, id, note),
            Edit::Expose { body, name, knob } => self.expose(body, name, knob),
            Edit::Unexpose { body, name } => self.unexpose(body, name),
            Edit::SetVariant { body, name, values } => self.set_variant(body, name, values),
            Edit::SetInput { body, name, input } => self.set_input(body, name, input),
            Edit::SetOutput { body, name, output } => self.set_output(body, name, output),
            Edit::AddGroup { name, group } => self.add_group(name, *group),
            Edit::SetGroup { name, group } => self.set_group(name, *group),
            Edit::RemoveGroup { name } => self.remove_group(name),
            Edit::RenameGroup { name, to, shown } => self.rename_group(name, to, shown),
            Edit::RenameDocument { name } => {
                let name = std::mem::replace(&mut self.name, name);
                Ok(Edit::RenameDocument { name })
            }
            Edit::SetPreview { preview } => self.set_preview(preview),
            Edit::SetFit { fit } => {
                let fit = validate::fit(fit).ok_or(EditError::BadFit)?;
                let fit = std::mem::replace(&mut self.fit, fit);
                Ok(Edit::SetFit { fit })
            }
            Edit::SetSeed { seed } => {
                let seed = std::mem::replace(&mut self.seed, seed);
                Ok(Edit::SetSeed { seed })
            }
            Edit::Replace { mut document } => {
                std::mem::swap(self, &mut document);
                Ok(Edit::Replace { document })
            }
            Edit::Batch(edits) => Ok(Edit::Batch(self.apply_all(edits)?)),
        }
    }

    /// Applies all edits, or no edit if one of them is refused. Returns their inverses in the order in which to apply them.
    fn apply_all(&mut self, edits: Vec<Edit>) -> Result<Vec<Edit>, EditError> {
        let mut inverses = Vec::with_capacity(edits.len());
        for edit in edits {
            match self.apply(edit) {
                Ok(inverse) => inverses.push(inverse),
                Err(error) => {
                    for inverse in inverses.into_iter().rev() {
                        // The inverse of an edit can be applied right after it.
                        let undone = self.apply(inverse);
                        debug_assert!(undone.is_ok(), "an inverse was refused: {undone:?}");
                    }
                    return Err(error);
                }
            }
        }
        inverses.reverse();
        Ok(inverses)
    }

    /// The graph of a body.
    ///
    /// # Errors
    /// There is no group of that name.
    pub fn body(&self, body: &Body) -> Result<&Graph, EditError> {
        match body {
            Body::Main => Ok(&self.graph),
            Body::Group(name) => match self.groups.get(name) {
                Some(group) => Ok(&group.graph),
                None => Err(missing("group", name, self.groups.keys())),
            },
        }
    }

    fn body_mut(&mut self, body: &Body) -> Result<&mut Graph, EditError> {
        // Checked first: the mutable borrow below would forbid listing the names.
        self.body(body)?;
        Ok(self.parts_mut(body)?.0)
    }

    /// Graph, inputs and outputs of a body.
    fn parts_mut(&mut self, body: &Body) -> Result<PartsMut<'_>, EditError> {
        self.body(body)?;
        match body {
            Body::Main => Ok((&mut self.graph, &mut self.inputs, &mut self.outputs)),
            Body::Group(name) => match self.groups.get_mut(name) {
                Some(group) => Ok((&mut group.graph, &mut group.inputs, &mut group.outputs)),
                None => Err(missing("group", name, std::iter::empty::<&String>())),
            },
        }
    }
}

/// Error for something that is missing, with the nearest name.
fn missing<'a>(what: &'static str, name: &str, known: impl IntoIterator<Item = &'a String>) -> EditError {
    EditError::Missing {
        what,
        name: quoted(name),
        hint: hint(name, known.into_iter().map(String::as_str)),
    }
}

/// Canonical form of a value.
fn canonical(name: &str, value: Value) -> Result<Value, Problem> {
    value
        .canonical()
        .ok_or_else(|| Problem::BadValue { name: quoted(name) })
}

/// Replaces values by their canonical forms.
fn make_canonical(values: &mut BTreeMap<String, Value>) -> Result<(), Problem> {
    for (name, value) in values {
        *value = canonical(name, std::mem::replace(value, Value::Null))?;
    }
    Ok(())
}
