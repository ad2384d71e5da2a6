//! Edits without effect.

use crate::{Document, Edit};

impl Document {
    /// Returns true if an edit would leave the document unchanged. Returns false for an edit that would be refused.
    pub fn is_unchanged_by(&self, edit: &Edit) -> bool {
        match edit {
            Edit::Batch(edits) => edits.iter().all(|edit| self.is_unchanged_by(edit)),
            Edit::SetParam { .. }
            | Edit::Connect { .. }
            | Edit::Disconnect { .. }
            | Edit::Move { .. }
            | Edit::SetMuted { .. }
            | Edit::SetDisplay { .. }
            | Edit::SetLabel { .. } => self.node_is_unchanged_by(edit),
            Edit::AddFrame { body, id, frame } => {
                self.body(body).is_ok_and(|graph| graph.frames().get(id) == Some(frame))
            }
            Edit::SetNote {
                body,
                id,
                note: Some(note),
            } => self.body(body).is_ok_and(|graph| graph.notes().get(id) == Some(note)),
            Edit::Expose { body, name, knob } => self
                .body(body)
                .is_ok_and(|graph| graph.exposed().get(name) == Some(knob)),
            Edit::SetVariant { body, name, values } => self
                .body(body)
                .is_ok_and(|graph| graph.variants().get(name) == values.as_ref()),
            Edit::SetInput { body, name, input } => self
                .ports(body)
                .is_ok_and(|(inputs, _)| inputs.get(name) == input.as_ref()),
            Edit::SetOutput { body, name, output } => self
                .ports(body)
                .is_ok_and(|(_, outputs)| outputs.get(name) == output.as_ref()),
            Edit::RenameGroup { name, to, shown } => {
                name == to && self.groups.get(name).is_some_and(|group| group.name == *shown)
            }
            Edit::SetGroup { name, group } => self.groups.get(name) == Some(&**group),
            Edit::RenameDocument { name } => self.name == *name,
            Edit::SetPreview { preview } => self.preview == *preview,
            Edit::SetFit { fit } => self.fit == *fit,
            Edit::SetSeed { seed } => self.seed == *seed,
            Edit::Replace { document } => *self == **document,
            Edit::AddNode { .. }
            | Edit::RemoveNode { .. }
            | Edit::RemoveFrame { .. }
            | Edit::SetNote { note: None, .. }
            | Edit::Unexpose { .. }
            | Edit::AddGroup { .. }
            | Edit::RemoveGroup { .. } => false,
        }
    }

    fn node_is_unchanged_by(&self, edit: &Edit) -> bool {
        let node = |body, id: &crate::NodeId| self.body(body).ok()?.node(id.as_str());
        let link = |body, id: &crate::NodeId, input: &str| self.body(body).ok()?.link_into(id.as_str(), input);
        match edit {
            Edit::SetParam {
                body,
                node: id,
                param,
                value,
            } => node(body, id).is_some_and(|node| match value {
                // A value without a canonical form is refused.
                Some(value) => match (value.clone().canonical(), node.params.get(param)) {
                    (Some(new), Some(old)) => new == *old,
                    _ => false,
                },
                None => !node.params.contains_key(param),
            }),
            Edit::Connect {
                body,
                node: id,
                input,
                from,
            } => link(body, id, input) == Some(from),
            Edit::Disconnect { body, node: id, input } => node(body, id).is_some() && link(body, id, input).is_none(),
            Edit::Move { body, node: id, pos } => node(body, id).is_some_and(|node| node.pos == *pos),
            Edit::SetMuted { body, node: id, muted } => node(body, id).is_some_and(|node| node.muted == *muted),
            Edit::SetDisplay {
                body,
                node: id,
                display,
            } => node(body, id).is_some_and(|node| node.display == *display),
            Edit::SetLabel { body, node: id, label } => node(body, id).is_some_and(|node| node.label == *label),
            _ => false,
        }
    }
}
