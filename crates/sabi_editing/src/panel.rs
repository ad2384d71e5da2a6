//! The panel of the graph that is seen: knobs that are published, for people who never open the graph.

use sabi_engine::catalog::Knob;
use sabi_graph::{Edit, Exposed, INSTANCE_KNOBS, NodeId, SlotRef, Value};

use super::OpenDocument;
use super::groups::{face_of, free_name};

/// A knob on the panel.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelKnob {
    /// Name in files and on command lines.
    pub name: String,
    /// What it says of itself.
    pub exposed: Exposed,
    /// What it looks like: the first knob that it turns, by its own name and range.
    pub knob: Knob,
    /// What it holds.
    pub value: Value,
    /// What it held when the graph was opened; for one that was published since, what its node's kind has at first.
    pub at_first: Value,
}

impl OpenDocument {
    /// The knobs on the panel, in its order. One that turns nothing which is known is left out.
    pub fn panel(&self) -> Vec<PanelKnob> {
        let face = self.own_face();
        let opened = face_of(&self.opened, &self.seen);
        let knobs = self.graph().panel().into_iter().filter_map(|(name, exposed)| {
            let knob = face?.knob(name)?.clone();
            let first = exposed.to.first()?;
            let inner = self.face(&first.node)?.knob(&first.name)?;
            let before = opened.and_then(|face| face.knob(name));
            Some(PanelKnob {
                at_first: before.map_or(&inner.ty.default, |knob| &knob.ty.default).clone(),
                name: name.to_owned(),
                exposed: exposed.clone(),
                // Of a published knob, it is what it holds while nobody outside sets it.
                value: knob.ty.default.clone(),
                knob,
            })
        });
        knobs.collect()
    }

    /// Publishes a knob of a node under a name of its own on the panel of the graph that is seen.
    pub fn expose(&mut self, id: &NodeId, knob: &str) -> bool {
        if let Some(name) = self.exposed_as(id, knob) {
            let why = format!("this knob is on the panel already, as '{name}'");
            return self.refuse(why);
        }
        let Some(label) = self
            .face(id)
            .and_then(|face| face.knob(knob))
            .map(|knob| knob.label.clone())
        else {
            let title = self.title(id);
            return self.refuse(format!("'{title}' has no knob '{knob}'"));
        };
        // Every instance has knobs of some names besides.
        let stem = match INSTANCE_KNOBS.contains(&knob) {
            true => format!(
                "{}_{knob}",
                id.as_str().rsplit_once('_').map_or(id.as_str(), |(stem, _)| stem)
            ),
            false => knob.to_owned(),
        };
        let name = free_name(&stem, '_', |name| self.graph().exposed().contains_key(name));
        let slot = SlotRef {
            node: id.clone(),
            name: knob.to_owned(),
        };
        let exposed = Exposed {
            to: vec![slot],
            label: Some(label),
            ..Exposed::default()
        };
        let edit = self.exposing(&name, exposed);
        self.edit("Expose", vec![edit])
    }

    /// Has a published knob turn one of a node too.
    pub fn expose_as(&mut self, id: &NodeId, knob: &str, name: &str) -> bool {
        let Some(mut exposed) = self.graph().exposed().get(name).cloned() else {
            return self.refuse(format!("there is no knob '{name}' on the panel"));
        };
        let slot = SlotRef {
            node: id.clone(),
            name: knob.to_owned(),
        };
        let first = exposed
            .to
            .first()
            .and_then(|slot| self.face(&slot.node)?.knob(&slot.name));
        let own = self.face(id).and_then(|face| face.knob(knob));
        let is_alike = first.zip(own).is_some_and(|(first, own)| {
            let like = |knob: &Knob| (knob.ty.role.clone(), knob.ty.memory);
            like(first) == like(own)
        });
        if !is_alike {
            return self.refuse(format!("'{name}' holds values of another sort than '{knob}'"));
        }
        if exposed.to.contains(&slot) {
            return true;
        }
        exposed.to.push(slot);
        let edit = self.exposing(name, exposed);
        self.edit("Expose", vec![edit])
    }

    /// The name under which a knob of a node is published.
    pub fn exposed_as(&self, id: &NodeId, knob: &str) -> Option<&str> {
        let turns = |slot: &SlotRef| slot.node == *id && slot.name == knob;
        let mut exposed = self.graph().exposed().iter();
        exposed
            .find(|(_, known)| known.to.iter().any(turns))
            .map(|(name, _)| name.as_str())
    }

    /// Takes a published knob back.
    pub fn unexpose(&mut self, name: &str) -> bool {
        let edit = Edit::Unexpose {
            body: self.body(),
            name: name.to_owned(),
        };
        self.edit("Take off the panel", vec![edit])
    }

    /// Takes one knob of a node off the panel; others that the same published knob turns stay.
    pub fn take_off_panel(&mut self, id: &NodeId, knob: &str) -> bool {
        let Some(name) = self.exposed_as(id, knob).map(str::to_owned) else {
            return false;
        };
        let Some(mut exposed) = self.graph().exposed().get(&name).cloned() else {
            return false;
        };
        exposed.to.retain(|slot| slot.node != *id || slot.name != knob);
        if exposed.to.is_empty() {
            return self.unexpose(&name);
        }
        let edit = self.exposing(&name, exposed);
        self.edit("Take off the panel", vec![edit])
    }

    /// Gives a published knob another name in files, in variants and in all instances.
    pub fn rename_exposed(&mut self, name: &str, to: &str) -> bool {
        let to = to.trim();
        let Some(exposed) = self.graph().exposed().get(name).cloned() else {
            return self.refuse(format!("there is no knob '{name}' on the panel"));
        };
        if name == to {
            return true;
        }
        if self.graph().exposed().contains_key(to) {
            return self.refuse(format!("there is a knob '{to}' already; choose another name"));
        }
        if INSTANCE_KNOBS.contains(&to) {
            return self.refuse(format!("every instance has a knob '{to}'; choose another name"));
        }
        let mut edits = vec![self.exposing(to, exposed)];
        for (variant, values) in self.graph().variants() {
            let mut values = values.clone();
            if let Some(value) = values.remove(name) {
                values.insert(to.to_owned(), value);
                edits.push(Edit::SetVariant {
                    body: self.body(),
                    name: variant.clone(),
                    values: Some(values),
                });
            }
        }
        edits.push(Edit::Unexpose {
            body: self.body(),
            name: name.to_owned(),
        });
        for (body, id, node) in self.instances_of_seen() {
            let Some(value) = node.params.get(name).cloned() else {
                continue;
            };
            for (param, value) in [(name, None), (to, Some(value))] {
                edits.push(Edit::SetParam {
                    body: body.clone(),
                    node: id.clone(),
                    param: param.to_owned(),
                    value,
                });
            }
        }
        let is_ours = self.is_of_instance();
        edits.extend(self.renamed_knobs(|body, slot| is_ours(body, slot) && slot.name == name, to));
        self.edit("Rename knob", edits)
    }

    /// Changes what a published knob says of itself; its name and what it turns stay.
    fn change_exposed(&mut self, step: &str, name: &str, change: impl FnOnce(&mut Exposed)) -> bool {
        let Some(mut exposed) = self.graph().exposed().get(name).cloned() else {
            return self.refuse(format!("there is no knob '{name}' on the panel"));
        };
        change(&mut exposed);
        let edit = self.exposing(name, exposed);
        self.edit(step, vec![edit])
    }

    /// Gives a published knob the name that artists see, or its own one back.
    pub fn label_exposed(&mut self, name: &str, label: &str) -> bool {
        let label = Some(label.trim().to_owned()).filter(|label| !label.is_empty());
        self.change_exposed("Rename knob", name, |knob| knob.label = label)
    }

    /// Puts a published knob into a section of the panel, or into none.
    pub fn set_section(&mut self, name: &str, section: &str) -> bool {
        let section = Some(section.trim().to_owned()).filter(|section| !section.is_empty());
        self.change_exposed("Move knob", name, |knob| knob.section = section)
    }

    /// Puts a published knob before another one, into whose section it comes, or at the end.
    pub fn move_exposed(&mut self, name: &str, before: Option<&str>) -> bool {
        let graph = self.graph();
        let mut names: Vec<&str> = graph.panel().into_iter().map(|(name, _)| name).collect();
        if !names.contains(&name) {
            return self.refuse(format!("there is no knob '{name}' on the panel"));
        }
        if before == Some(name) {
            return true;
        }
        names.retain(|other| *other != name);
        let at = before.and_then(|before| names.iter().position(|other| *other == before));
        let at = at.unwrap_or(names.len());
        let beside = names
            .get(at)
            .or(names.last())
            .and_then(|other| graph.exposed().get(*other));
        let section = beside.map(|other| other.section.clone());
        names.insert(at, name);
        let mut edits = Vec::new();
        for (order, known) in (1..).zip(&names) {
            let Some(mut exposed) = graph.exposed().get(*known).cloned() else {
                continue;
            };
            exposed.order = Some(order);
            if let Some(section) = section.as_ref().filter(|_| *known == name) {
                exposed.section = section.clone();
            }
            edits.push(self.exposing(known, exposed));
        }
        self.edit("Move knob", edits)
    }

    /// The edit that has a published knob say this of itself.
    pub(super) fn exposing(&self, name: &str, knob: Exposed) -> Edit {
        Edit::Expose {
            body: self.body(),
            name: name.to_owned(),
            knob,
        }
    }
}
