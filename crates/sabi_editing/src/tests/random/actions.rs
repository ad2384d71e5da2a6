//! Random actions on a document.

use std::collections::BTreeSet;
use std::path::Path;

use super::super::*;
use super::split_mix::SplitMix64;
use crate::command::{ExposedCommand, LayerCommand, NodeSource, perform};
use crate::dropped_layers::DroppedOn;

/// A document, and a source of random actions on it.
pub(super) struct RandomActions {
    pub(super) document: OpenDocument,
    pub(super) dice: SplitMix64,
    pub(super) clipboard: String,
    pub(super) kinds: Vec<String>,
    /// Texts that may be on the disk: the one last reported as saved or kept, and those after it.
    pub(super) safe: Vec<String>,
}

impl RandomActions {
    pub(super) fn ids(&self) -> Vec<NodeId> {
        self.document.graph().ids().cloned().collect()
    }

    fn id(&mut self) -> NodeId {
        let ids = self.ids();
        let found = if self.dice.one_in(30) {
            None
        } else {
            self.dice.pick(&ids)
        };
        found.unwrap_or_else(|| id("gone"))
    }

    fn kind(&mut self) -> String {
        match self.dice.below(6) {
            0 => self.dice.word(&[
                "source/material",
                "effect/layer",
                "material/blend",
                "output/material",
                "effect/relief",
            ]),
            1 => self.dice.word(&[
                "blend/mask",
                "adjust/levels",
                "graph/reroute",
                "source/image",
                "lost/kind",
            ]),
            _ => {
                let kinds = self.kinds.clone();
                self.dice.pick(&kinds).unwrap_or_default()
            }
        }
    }

    fn output(&mut self) -> OutputRef {
        let node = self.id();
        let interface = self.document.interface(&node).cloned();
        let mut ports: Vec<Option<String>> = vec![None];
        ports.extend(
            interface
                .iter()
                .flat_map(|interface| &interface.outputs)
                .map(|port| Some(port.name.clone())),
        );
        if self.dice.one_in(40) {
            ports = vec![Some("nothing".to_owned())];
        }
        let port = self.dice.pick(&ports).flatten();
        OutputRef { node, port }
    }

    fn input(&mut self) -> SlotRef {
        let node = self.id();
        let interface = self.document.interface(&node).cloned();
        let names: Vec<String> = interface
            .iter()
            .flat_map(|interface| &interface.inputs)
            .map(|port| port.name.clone())
            .collect();
        let name = self.dice.pick(&names).unwrap_or_else(|| "nothing".to_owned());
        SlotRef { node, name }
    }

    fn knob(&mut self) -> (NodeId, String) {
        let node = self.id();
        let interface = self.document.interface(&node).cloned();
        let names: Vec<String> = interface
            .iter()
            .flat_map(|interface| &interface.knobs)
            .map(|knob| knob.name.clone())
            .collect();
        let other = self
            .dice
            .word(&["size", "opacity", "file", "seed", "scale", "variant", ""]);
        let name = self.dice.pick(&names).filter(|_| !self.dice.one_in(20));
        (node, name.unwrap_or(other))
    }

    fn group(&mut self) -> String {
        let names: Vec<String> = self.document.contents().groups.keys().cloned().collect();
        self.dice.pick(&names).unwrap_or_else(|| "Group".to_owned())
    }

    fn exposed(&mut self) -> String {
        let names: Vec<String> = self.document.graph().exposed().keys().cloned().collect();
        self.dice.pick(&names).unwrap_or_else(|| "nothing".to_owned())
    }

    fn name(&mut self) -> String {
        self.dice.word(&[
            "", "a", "b", "size", "seed", "none", "v", "Dust", "x.sabi", "a.b", " c ",
        ])
    }

    fn loose(&mut self) -> Option<PendingWire> {
        match self.dice.below(3) {
            0 => None,
            1 => Some(PendingWire::From(self.output())),
            _ => Some(PendingWire::Into(self.input())),
        }
    }

    /// Performs one random action.
    pub(super) fn act(&mut self, folder: &Path) {
        match self.dice.below(25) {
            0..=4 => {
                let (kind, pos, loose) = (self.kind(), self.dice.place(), self.loose());
                nodes::add(&mut self.document, &kind, pos, loose.as_ref());
            }
            5..=7 => {
                self.wire();
            }
            8 | 9 => {
                self.turn();
            }
            10 | 11 => {
                let ids: Vec<NodeId> = self.ids().into_iter().filter(|_| self.dice.one_in(3)).collect();
                self.document.select(ids);
                if self.dice.one_in(8) {
                    selection::select_connected(&mut self.document, self.dice.one_in(2));
                }
            }
            12..=14 => {
                self.change_nodes();
            }
            15..=17 => {
                self.change_groups();
            }
            18 => {
                self.arrange();
            }
            19 | 20 => {
                self.expose();
            }
            21 => self.stack(),
            22 => {
                for _ in 0..self.dice.below(6) {
                    match self.dice.one_in(2) {
                        true => history::undo(&mut self.document),
                        false => history::redo(&mut self.document),
                    }
                }
            }
            23 => self.drop_or_roll(),
            _ => self.keep(folder),
        }
    }

    /// Drops a layer on the model or on a node, or sets random values.
    fn drop_or_roll(&mut self) {
        let (kind, group, node) = (self.kind(), self.group(), self.id());
        let source = match self.dice.one_in(2) {
            true => NodeSource::Kind(kind),
            false => NodeSource::Group(group),
        };
        let ends: Vec<StackEnd> = stack::all(&self.document).into_iter().map(|stack| stack.end).collect();
        let place = match self.dice.below(3) {
            0 => DroppedOn::Unknown,
            1 => DroppedOn::Material("glass".to_owned()),
            _ => self.dice.pick(&ends).map_or(DroppedOn::Unknown, DroppedOn::Output),
        };
        let command = match self.dice.below(4) {
            0 => LayerCommand::AddOnNode { source, node }.into(),
            1 | 2 => {
                let has_normal_map = self.dice.one_in(2);
                LayerCommand::AddOnModel {
                    source,
                    place,
                    has_normal_map,
                }
                .into()
            }
            _ => ExposedCommand::Randomize { kept: BTreeSet::new() }.into(),
        };
        perform(&mut self.document, command);
    }

    fn wire(&mut self) -> bool {
        let (from, to) = (self.output(), self.input());
        match self.dice.below(12) {
            0 => wires::disconnect(&mut self.document, &[to]),
            1 => {
                let node = self.id();
                let may = wires::can_insert(&self.document, &node, &to);
                assert_eq!(wires::insert(&mut self.document, &node, &to), may);
                may
            }
            2 => wires::reroute(&mut self.document, &to, self.dice.place()),
            3 => {
                let (_, how) = self.dice.pick(&MaskMerge::OFFERED).unwrap_or(MaskMerge::OFFERED[0]);
                wires::can_merge(&self.document, &from, &to);
                wires::merge(&mut self.document, &from, &to, how)
            }
            4 => wires::swap_inputs(&mut self.document),
            5 => wires::detach_selected(&mut self.document),
            _ => {
                let fits = wires::check(&self.document, &from, &to).is_ok();
                assert_eq!(wires::connect(&mut self.document, &from, &to), fits, "{from} into {to}");
                fits
            }
        }
    }

    fn turn(&mut self) -> bool {
        let ((node, knob), value) = (self.knob(), self.dice.value());
        match self.dice.below(4) {
            0 => {
                self.document.session.begin("Drag");
                for _ in 0..5 {
                    let value = self.dice.value();
                    nodes::set_knob(&mut self.document, &node, &knob, value);
                }
                self.document.session.end();
                true
            }
            1 => nodes::set_knob_of_selected(&mut self.document, &node, &knob, value),
            _ => nodes::set_knob(&mut self.document, &node, &knob, value),
        }
    }

    fn change_nodes(&mut self) -> bool {
        match self.dice.below(12) {
            0 => nodes::delete(&mut self.document, self.dice.one_in(2)),
            1 => nodes::toggle_muted(&mut self.document),
            2 => duplication::duplicate(&mut self.document, self.dice.one_in(2)),
            3 => {
                let (node, kind) = (self.id(), self.kind());
                node_replacement::by_kind(&mut self.document, &node, &kind)
            }
            4 => {
                let (node, name) = (self.id(), self.name());
                nodes::rename(&mut self.document, &node, &name)
            }
            5 => {
                self.clipboard = clipboard::copy(&self.document).unwrap_or_default();
                true
            }
            6 => {
                self.clipboard = clipboard::cut(&mut self.document).unwrap_or_default();
                true
            }
            7 | 8 => {
                let pos = self.dice.place();
                clipboard::paste(&mut self.document, &self.clipboard.clone(), pos)
            }
            9 => frames::add(&mut self.document),
            10 => {
                let frames: Vec<String> = self.document.graph().frames().keys().cloned().collect();
                let frame = self.dice.pick(&frames).unwrap_or_default();
                let nodes = self.document.selection().clone();
                match self.dice.below(3) {
                    0 => frames::remove(&mut self.document, &frame),
                    1 => frames::assign(&mut self.document, &nodes, None),
                    _ => frames::assign(&mut self.document, &nodes, Some(&frame)),
                }
            }
            _ => nodes::delete(&mut self.document, true),
        }
    }

    fn change_groups(&mut self) -> bool {
        let (group, name, input, output) = (self.group(), self.name(), self.input(), self.output());
        let of = |names: Vec<&String>, dice: &mut SplitMix64| dice.pick(&names).cloned().unwrap_or_default();
        let port_in = of(ports::inputs(&self.document).keys().collect(), &mut self.dice);
        let port_out = of(ports::outputs(&self.document).keys().collect(), &mut self.dice);
        match self.dice.below(16) {
            0 | 1 => groups::make(&mut self.document),
            2 => groups::dissolve_selected(&mut self.document),
            3..=5 => {
                let instances: Vec<NodeId> = self.ids();
                let is_instance = |id: &NodeId| self.document.node(id).is_some_and(|node| node.group.is_some());
                let instances: Vec<NodeId> = instances.into_iter().filter(is_instance).collect();
                let instance = self.dice.pick(&instances);
                instance.is_some_and(|instance| navigation::enter(&mut self.document, &instance))
            }
            6 | 7 => navigation::leave(&mut self.document),
            8 => {
                let (pos, loose) = (self.dice.place(), self.loose());
                nodes::add_instance(&mut self.document, &group, pos, loose.as_ref()).is_some()
            }
            9 => groups::rename(&mut self.document, &group, &name),
            10 => ports::expose_input(&mut self.document, &input).is_some(),
            11 => ports::expose_output(&mut self.document, &output).is_some(),
            12 => ports::feed(&mut self.document, &port_in, &input) || ports::unfeed(&mut self.document, &input),
            13 => {
                ports::rename_input(&mut self.document, &port_in, &name)
                    || ports::rename_output(&mut self.document, &port_out, &name)
            }
            14 => {
                ports::retarget_output(&mut self.document, &port_out, &output)
                    || ports::set_input_label(&mut self.document, &port_in, &name)
            }
            _ => match self.dice.one_in(2) {
                true => ports::remove_input(&mut self.document, &port_in),
                false => ports::remove_output(&mut self.document, &port_out),
            },
        }
    }

    fn arrange(&mut self) -> bool {
        match self.dice.below(5) {
            0 => arrangement::align(
                &mut self.document,
                [Align::Left, Align::Right, Align::Top, Align::Bottom][self.dice.below(4)],
            ),
            1 => arrangement::straighten(&mut self.document),
            2 => arrangement::lay_out(&mut self.document),
            _ => {
                let places = arrangement::selected_positions(&self.document)
                    .into_keys()
                    .map(|id| (id, self.dice.place()));
                let places = places.collect();
                arrangement::move_nodes(&mut self.document, "Move", places)
            }
        }
    }

    fn expose(&mut self) -> bool {
        let ((node, knob), name, exposed) = (self.knob(), self.name(), self.exposed());
        let (value, end) = (self.dice.value(), self.dice.below(4) as f64);
        let variants: Vec<String> = self.document.graph().variants().keys().cloned().collect();
        let variant = self.dice.pick(&variants).unwrap_or_default();
        let document = &mut self.document;
        match self.dice.below(16) {
            0..=3 => exposed_knobs::expose(document, &node, &knob),
            4 => exposed_knobs::unexpose(document, &exposed),
            5 => {
                exposed_knobs::expose_also(document, &node, &knob, &exposed)
                    || exposed_knobs::unexpose_knob(document, &node, &knob)
            }
            6 => exposed_knobs::rename(document, &exposed, &name),
            7 => {
                exposed_knobs::set_label(document, &exposed, &name)
                    && exposed_knobs::set_section(document, &exposed, &name)
            }
            8 => exposed_knobs::move_knob(document, &exposed, Some(&name)),
            9 => exposed_values::set_range(document, &exposed, Some([0.0, end]).filter(|_| end > 0.0)),
            10 => exposed_values::set_default(document, &exposed, value),
            11 | 12 => exposed_values::set(document, &exposed, &value.unwrap_or(Value::Null)),
            13 => variants::save(document, &name),
            14 => variants::show(document, Some(&*variant).filter(|name| !name.is_empty())),
            _ => variants::rename(document, &variant, &name) || variants::remove(document, &variant),
        }
    }

    fn stack(&mut self) {
        let Some(stack) = self.dice.pick(&stack::all(&self.document)) else {
            return;
        };
        let [one, other] = [0, 1].map(|_| self.dice.below(stack.layers.len() + 1));
        match self.dice.below(5) {
            0 => {
                let kind = self.kind();
                layers::add(&mut self.document, &stack.end, one, &kind);
            }
            1 => {
                layers::remove(&mut self.document, &stack.end, one);
            }
            2 => {
                if let Some(layer) = stack.layers.get(one) {
                    layers::toggle(&mut self.document, &layer.node);
                    layers::set_opacity(&mut self.document, &layer.node, other as f64 / 4.0);
                }
            }
            _ => {
                layers::move_to(&mut self.document, &stack.end, one, other);
            }
        }
    }
}
