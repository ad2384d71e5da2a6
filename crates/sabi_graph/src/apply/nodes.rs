//! Edits of nodes and links.

use std::collections::BTreeMap;

use super::{canonical, make_canonical};
use crate::id_text::check_port_name;
use crate::problem::Problem;
use crate::validate;
use crate::{Body, Document, Edit, EditError, Node, NodeDisplay, NodeId, OutputRef, Value};

impl Document {
    pub(super) fn add_node(
        &mut self,
        body: Body,
        id: NodeId,
        mut node: Node,
        inputs: BTreeMap<String, OutputRef>,
    ) -> Result<Edit, EditError> {
        let graph = self.body(&body)?;
        if graph.node(id.as_str()).is_some() {
            return Err(Problem::NodeExists { id }.into());
        }
        let groups = || self.groups.keys().map(String::as_str);
        validate::kind_and_group(&node, |name| self.groups.contains_key(name), groups())?;
        make_canonical(&mut node.params)?;
        make_canonical(&mut node.extra)?;
        check_position(node.pos)?;
        for (input, from) in &inputs {
            check_port_name(input)?;
            check_output(from)?;
            if from.node == id {
                return Err(Problem::SelfLink { id }.into());
            }
            graph.find(from.node.as_str())?;
        }
        let graph = self.body_mut(&body)?;
        graph.insert(id.clone(), node)?;
        // No node reads the new node yet, so its links cannot close a circle.
        for (input, from) in inputs {
            graph.link(&id, input, from)?;
        }
        // A frame may name the node already, as after a merge of two branches; removing the node must not change that.
        let naming = graph.frames().iter().filter(|(_, frame)| frame.nodes.contains(&id));
        let frames: Vec<Edit> = naming
            .map(|(frame_id, frame)| Edit::AddFrame {
                body: body.clone(),
                id: frame_id.clone(),
                frame: frame.clone(),
            })
            .collect();
        let remove = Edit::RemoveNode { body, id };
        Ok(match frames.is_empty() {
            true => remove,
            false => Edit::Batch([vec![remove], frames].concat()),
        })
    }

    /// Removes everything that refers to the node, each by an edit, and then the node. The inverse restores it all.
    pub(super) fn remove_node(&mut self, body: Body, id: NodeId) -> Result<Edit, EditError> {
        self.body(&body)?.find(id.as_str())?;
        let unlinking = self.edits_that_unlink(&body, &id)?;
        let mut inverse = self.apply_all(unlinking)?;
        let graph = self.body_mut(&body)?;
        let inputs = graph.inputs(id.as_str()).into_iter();
        let inputs = inputs.map(|(input, from)| (input.to_owned(), from.clone())).collect();
        let node = graph.remove(&id)?;
        inverse.insert(0, Edit::AddNode { body, id, node, inputs });
        Ok(Edit::Batch(inverse))
    }

    /// Edits that remove all references to the node.
    fn edits_that_unlink(&self, body: &Body, id: &NodeId) -> Result<Vec<Edit>, EditError> {
        let graph = self.body(body)?;
        let (inputs, outputs) = self.ports(body)?;
        let mut edits = Vec::new();
        for slot in graph.readers(id.as_str()) {
            edits.push(Edit::Disconnect {
                body: body.clone(),
                node: slot.node,
                input: slot.name,
            });
        }
        for (frame_id, frame) in graph.frames().iter().filter(|(_, frame)| frame.nodes.contains(id)) {
            let mut frame = frame.clone();
            frame.nodes.retain(|node| node != id);
            edits.push(Edit::AddFrame {
                body: body.clone(),
                id: frame_id.clone(),
                frame,
            });
        }
        for (name, knob) in graph.exposed() {
            let mut knob = knob.clone();
            let before = knob.to.len();
            knob.to.retain(|slot| slot.node != *id);
            if knob.to.len() < before {
                let (body, name) = (body.clone(), name.clone());
                // A knob that sets nothing is no longer exposed.
                edits.push(match knob.to.is_empty() {
                    true => Edit::Unexpose { body, name },
                    false => Edit::Expose { body, name, knob },
                });
            }
        }
        for (name, input) in inputs
            .iter()
            .filter(|(_, input)| input.to.iter().any(|slot| slot.node == *id))
        {
            let mut input = input.clone();
            input.to.retain(|slot| slot.node != *id);
            edits.push(Edit::SetInput {
                body: body.clone(),
                name: name.clone(),
                input: Some(input),
            });
        }
        for (name, _) in outputs.iter().filter(|(_, from)| from.node == *id) {
            edits.push(Edit::SetOutput {
                body: body.clone(),
                name: name.clone(),
                output: None,
            });
        }
        Ok(edits)
    }

    pub(super) fn set_param(
        &mut self,
        body: Body,
        node: NodeId,
        param: String,
        value: Option<Value>,
    ) -> Result<Edit, EditError> {
        let value = value.map(|value| canonical(&param, value)).transpose()?;
        let params = &mut self.body_mut(&body)?.node_mut(&node)?.params;
        let value = match value {
            Some(value) => params.insert(param.clone(), value),
            None => params.remove(&param),
        };
        Ok(Edit::SetParam {
            body,
            node,
            param,
            value,
        })
    }

    pub(super) fn connect(
        &mut self,
        body: Body,
        node: NodeId,
        input: String,
        from: OutputRef,
    ) -> Result<Edit, EditError> {
        check_port_name(&input)?;
        check_output(&from)?;
        let graph = self.body_mut(&body)?;
        if from.node == node {
            graph.find(node.as_str())?;
            return Err(Problem::SelfLink { id: node }.into());
        }
        graph.circle_closed_by(&from.node, &node)?;
        let before = graph.unlink(&node, &input)?;
        graph.link(&node, input.clone(), from)?;
        Ok(Edit::link(body, node, input, before))
    }

    pub(super) fn disconnect(&mut self, body: Body, node: NodeId, input: String) -> Result<Edit, EditError> {
        let before = self.body_mut(&body)?.unlink(&node, &input)?;
        Ok(Edit::link(body, node, input, before))
    }

    pub(super) fn move_node(&mut self, body: Body, node: NodeId, pos: [f32; 2]) -> Result<Edit, EditError> {
        check_position(pos)?;
        let pos = std::mem::replace(&mut self.body_mut(&body)?.node_mut(&node)?.pos, pos);
        Ok(Edit::Move { body, node, pos })
    }

    pub(super) fn set_muted(&mut self, body: Body, node: NodeId, muted: bool) -> Result<Edit, EditError> {
        let muted = std::mem::replace(&mut self.body_mut(&body)?.node_mut(&node)?.muted, muted);
        Ok(Edit::SetMuted { body, node, muted })
    }

    pub(super) fn set_display(&mut self, body: Body, node: NodeId, display: NodeDisplay) -> Result<Edit, EditError> {
        let display = std::mem::replace(&mut self.body_mut(&body)?.node_mut(&node)?.display, display);
        Ok(Edit::SetDisplay { body, node, display })
    }

    pub(super) fn set_label(&mut self, body: Body, node: NodeId, label: Option<String>) -> Result<Edit, EditError> {
        let label = std::mem::replace(&mut self.body_mut(&body)?.node_mut(&node)?.label, label);
        Ok(Edit::SetLabel { body, node, label })
    }
}

pub(super) fn check_position(pos: [f32; 2]) -> Result<(), EditError> {
    match pos.iter().all(|x| x.is_finite()) {
        true => Ok(()),
        false => Err(EditError::BadPosition),
    }
}

pub(super) fn check_output(from: &OutputRef) -> Result<(), Problem> {
    from.port.as_deref().map_or(Ok(()), check_port_name)
}
