//! Edits of exposed knobs, variants and ports, and of frames and notes.

use std::collections::BTreeMap;

use super::nodes::{check_output, check_position};
use super::{canonical, make_canonical, missing};
use crate::document::GroupInput;
use crate::graph::{ExposedParameter, Frame};
use crate::id_text::check_port_name;
use crate::name::check_name;
use crate::problem::{Problem, quoted};
use crate::validate;
use crate::{Body, Document, Edit, EditError, Note, OutputRef, Preview, Value};

/// Inputs and outputs of a body.
type GroupPorts<'a> = (&'a BTreeMap<String, GroupInput>, &'a BTreeMap<String, OutputRef>);

impl Document {
    pub(super) fn ports(&self, body: &Body) -> Result<GroupPorts<'_>, EditError> {
        match body {
            Body::Main => Ok((&self.inputs, &self.outputs)),
            Body::Group(name) => match self.groups.get(name) {
                Some(group) => Ok((&group.inputs, &group.outputs)),
                None => Err(missing("group", name, self.groups.keys())),
            },
        }
    }

    pub(super) fn set_preview(&mut self, mut preview: Option<Preview>) -> Result<Edit, EditError> {
        if let Some(preview) = &mut preview {
            make_canonical(&mut preview.extra)?;
            validate::views(&mut preview.views)?;
        }
        let preview = std::mem::replace(&mut self.preview, preview);
        Ok(Edit::SetPreview { preview })
    }

    pub(super) fn add_frame(&mut self, body: Body, id: String, mut frame: Frame) -> Result<Edit, EditError> {
        check_name("frame", &id, "")?;
        make_canonical(&mut frame.extra)?;
        Ok(match self.body_mut(&body)?.frames.insert(id.clone(), frame) {
            Some(frame) => Edit::AddFrame { body, id, frame },
            None => Edit::RemoveFrame { body, id },
        })
    }

    pub(super) fn remove_frame(&mut self, body: Body, id: String) -> Result<Edit, EditError> {
        let frames = &mut self.body_mut(&body)?.frames;
        match frames.remove(&id) {
            Some(frame) => Ok(Edit::AddFrame { body, id, frame }),
            None => Err(missing("frame", &id, frames.keys())),
        }
    }

    pub(super) fn set_note(&mut self, body: Body, id: String, mut note: Option<Note>) -> Result<Edit, EditError> {
        check_name("note", &id, "")?;
        if let Some(note) = &mut note {
            make_canonical(&mut note.extra)?;
            check_position(note.pos)?;
            check_position([note.width; 2])?;
        }
        let notes = &mut self.body_mut(&body)?.notes;
        let note = match note {
            Some(note) => notes.insert(id.clone(), note),
            None => Some(notes.remove(&id).ok_or_else(|| missing("note", &id, notes.keys()))?),
        };
        Ok(Edit::SetNote { body, id, note })
    }

    pub(super) fn expose(&mut self, body: Body, name: String, mut knob: ExposedParameter) -> Result<Edit, EditError> {
        let graph = self.body_mut(&body)?;
        validate::knob(graph, &name, &knob)?;
        knob.default = knob.default.map(|value| canonical("default", value)).transpose()?;
        if let Some(ends) = &mut knob.range {
            for end in ends {
                let bad = || Problem::BadValue { name: quoted("range") };
                *end = crate::canonical_number(*end).ok_or_else(bad)?;
            }
        }
        make_canonical(&mut knob.extra)?;
        Ok(match graph.exposed.insert(name.clone(), knob) {
            Some(knob) => Edit::Expose { body, name, knob },
            None => Edit::Unexpose { body, name },
        })
    }

    /// Removes the knob from the variants first, so that a variant never sets a knob that is not exposed.
    pub(super) fn unexpose(&mut self, body: Body, name: String) -> Result<Edit, EditError> {
        let graph = self.body_mut(&body)?;
        let Some(knob) = graph.exposed.remove(&name) else {
            return Err(missing("knob", &name, graph.exposed.keys()));
        };
        let mut inverse = vec![Edit::Expose {
            body: body.clone(),
            name: name.clone(),
            knob,
        }];
        for (variant, values) in &mut graph.variants {
            if values.contains_key(&name) {
                let (body, name_of_variant) = (body.clone(), variant.clone());
                inverse.push(Edit::SetVariant {
                    body,
                    name: name_of_variant,
                    values: Some(values.clone()),
                });
                values.remove(&name);
            }
        }
        Ok(Edit::Batch(inverse))
    }

    pub(super) fn set_variant(
        &mut self,
        body: Body,
        name: String,
        mut values: Option<BTreeMap<String, Value>>,
    ) -> Result<Edit, EditError> {
        check_name("variant", &name, "")?;
        let graph = self.body_mut(&body)?;
        if let Some(values) = &mut values {
            for knob in values.keys() {
                validate::variant_sets(graph, &name, knob)?;
            }
            make_canonical(values)?;
        }
        let values = match values {
            Some(values) => graph.variants.insert(name.clone(), values),
            None => graph.variants.remove(&name),
        };
        Ok(Edit::SetVariant { body, name, values })
    }

    pub(super) fn set_input(&mut self, body: Body, name: String, input: Option<GroupInput>) -> Result<Edit, EditError> {
        let (graph, inputs, _) = self.parts_mut(&body)?;
        let input = match input {
            Some(mut input) => {
                let mut fed = validate::FedInputs::new();
                for (other, input) in inputs.iter().filter(|(other, _)| **other != name) {
                    fed.extend(input.to.iter().map(|slot| (slot.clone(), other.clone())));
                }
                validate::group_input(graph, &mut fed, &name, &input)?;
                make_canonical(&mut input.extra)?;
                inputs.insert(name.clone(), input)
            }
            None => inputs.remove(&name),
        };
        Ok(Edit::SetInput { body, name, input })
    }

    pub(super) fn set_output(
        &mut self,
        body: Body,
        name: String,
        output: Option<OutputRef>,
    ) -> Result<Edit, EditError> {
        let (graph, _, outputs) = self.parts_mut(&body)?;
        let output = match output {
            Some(from) => {
                check_port_name(&name)?;
                check_output(&from)?;
                graph.find(from.node.as_str())?;
                outputs.insert(name.clone(), from)
            }
            None => outputs.remove(&name),
        };
        Ok(Edit::SetOutput { body, name, output })
    }
}
