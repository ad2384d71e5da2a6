//! Hands that know no plan: each does one thing after another to a document.

use std::path::Path;

use super::super::super::{Align, MaskMerge};
use super::super::*;
use super::dice::Dice;

/// A document, and hands that know no plan.
pub(super) struct Hands {
    pub(super) document: OpenDocument,
    pub(super) dice: Dice,
    pub(super) clipboard: String,
    pub(super) kinds: Vec<String>,
}

impl Hands {
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
        let face = self.document.face(&node).cloned();
        let mut ports: Vec<Option<String>> = vec![None];
        ports.extend(
            face.iter()
                .flat_map(|face| &face.outputs)
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
        let face = self.document.face(&node).cloned();
        let names: Vec<String> = face
            .iter()
            .flat_map(|face| &face.inputs)
            .map(|port| port.name.clone())
            .collect();
        let name = self.dice.pick(&names).unwrap_or_else(|| "nothing".to_owned());
        SlotRef { node, name }
    }

    fn knob(&mut self) -> (NodeId, String) {
        let node = self.id();
        let face = self.document.face(&node).cloned();
        let names: Vec<String> = face
            .iter()
            .flat_map(|face| &face.knobs)
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

    fn published(&mut self) -> String {
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

    /// Does one thing.
    pub(super) fn act(&mut self, folder: &Path) {
        match self.dice.below(24) {
            0..=4 => {
                let (kind, pos, loose) = (self.kind(), self.dice.place(), self.loose());
                self.document.add(&kind, pos, loose.as_ref());
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
                    self.document.select_stream(self.dice.one_in(2));
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
                self.publish();
            }
            21 => self.stack(),
            22 => {
                for _ in 0..self.dice.below(6) {
                    match self.dice.one_in(2) {
                        true => self.document.undo(),
                        false => self.document.redo(),
                    }
                }
            }
            _ => self.keep(folder),
        }
    }

    fn wire(&mut self) -> bool {
        let (from, to) = (self.output(), self.input());
        match self.dice.below(12) {
            0 => self.document.cut(&[to]),
            1 => {
                let node = self.id();
                let may = self.document.may_insert(&node, &to);
                assert_eq!(self.document.insert(&node, &to), may);
                may
            }
            2 => self.document.reroute(&to, self.dice.place()),
            3 => {
                let (_, how) = self.dice.pick(&MaskMerge::OFFERED).unwrap_or(MaskMerge::OFFERED[0]);
                self.document.may_merge(&from, &to);
                self.document.merge(&from, &to, how)
            }
            4 => self.document.swap_inputs(),
            5 => self.document.take_out(),
            _ => {
                let fits = self.document.fits(&from, &to).is_ok();
                assert_eq!(self.document.connect(&from, &to), fits, "{from} into {to}");
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
                    self.document.set_knob(&node, &knob, value);
                }
                self.document.session.end();
                true
            }
            1 => self.document.set_knob_of_alike(&node, &knob, value),
            _ => self.document.set_knob(&node, &knob, value),
        }
    }

    fn change_nodes(&mut self) -> bool {
        match self.dice.below(12) {
            0 => self.document.delete(self.dice.one_in(2)),
            1 => self.document.mute(),
            2 => self.document.duplicate(self.dice.one_in(2)),
            3 => {
                let (node, kind) = (self.id(), self.kind());
                self.document.replace(&node, &kind)
            }
            4 => {
                let (node, name) = (self.id(), self.name());
                self.document.rename(&node, &name)
            }
            5 => {
                self.clipboard = self.document.copied().unwrap_or_default();
                true
            }
            6 => {
                self.clipboard = self.document.cut_out().unwrap_or_default();
                true
            }
            7 | 8 => {
                let pos = self.dice.place();
                self.document.paste(&self.clipboard.clone(), pos)
            }
            9 => self.document.frame(),
            10 => {
                let frames: Vec<String> = self.document.graph().frames().keys().cloned().collect();
                let frame = self.dice.pick(&frames).unwrap_or_default();
                let nodes = self.document.selection().clone();
                match self.dice.below(3) {
                    0 => self.document.remove_frame(&frame),
                    1 => self.document.put_into_frame(&nodes, None),
                    _ => self.document.put_into_frame(&nodes, Some(&frame)),
                }
            }
            _ => self.document.delete(true),
        }
    }

    fn change_groups(&mut self) -> bool {
        let (group, name, input, output) = (self.group(), self.name(), self.input(), self.output());
        let of = |names: Vec<&String>, dice: &mut Dice| dice.pick(&names).cloned().unwrap_or_default();
        let port_in = of(self.document.group_inputs().keys().collect(), &mut self.dice);
        let port_out = of(self.document.group_outputs().keys().collect(), &mut self.dice);
        match self.dice.below(16) {
            0 | 1 => self.document.make_group(),
            2 => self.document.dissolve_groups(),
            3..=5 => {
                let instances: Vec<NodeId> = self.ids();
                let is_instance = |id: &NodeId| self.document.node(id).is_some_and(|node| node.group.is_some());
                let instances: Vec<NodeId> = instances.into_iter().filter(is_instance).collect();
                let instance = self.dice.pick(&instances);
                instance.is_some_and(|instance| self.document.enter(&instance))
            }
            6 | 7 => self.document.leave(),
            8 => {
                let (pos, loose) = (self.dice.place(), self.loose());
                self.document.add_group_instance(&group, pos, loose.as_ref()).is_some()
            }
            9 => self.document.rename_group(&group, &name),
            10 => self.document.publish_input(&input).is_some(),
            11 => self.document.publish_output(&output).is_some(),
            12 => self.document.feed(&port_in, &input) || self.document.unfeed(&input),
            13 => self.document.rename_input(&port_in, &name) || self.document.rename_output(&port_out, &name),
            14 => self.document.retarget_output(&port_out, &output) || self.document.label_input(&port_in, &name),
            _ => match self.dice.one_in(2) {
                true => self.document.remove_input(&port_in),
                false => self.document.remove_output(&port_out),
            },
        }
    }

    fn arrange(&mut self) -> bool {
        match self.dice.below(5) {
            0 => self
                .document
                .align([Align::Left, Align::Right, Align::Top, Align::Bottom][self.dice.below(4)]),
            1 => self.document.straighten(),
            2 => self.document.lay_out(),
            _ => {
                let places = self.document.places().into_keys().map(|id| (id, self.dice.place()));
                let places = places.collect();
                self.document.move_to("Move", places)
            }
        }
    }

    fn publish(&mut self) -> bool {
        let ((node, knob), name, published) = (self.knob(), self.name(), self.published());
        let (value, end) = (self.dice.value(), self.dice.below(4) as f64);
        let variants: Vec<String> = self.document.graph().variants().keys().cloned().collect();
        let variant = self.dice.pick(&variants).unwrap_or_default();
        let document = &mut self.document;
        match self.dice.below(16) {
            0..=3 => document.expose(&node, &knob),
            4 => document.unexpose(&published),
            5 => document.expose_as(&node, &knob, &published) || document.take_off_panel(&node, &knob),
            6 => document.rename_exposed(&published, &name),
            7 => document.label_exposed(&published, &name) && document.set_section(&published, &name),
            8 => document.move_exposed(&published, Some(&name)),
            9 => document.set_exposed_range(&published, Some([0.0, end]).filter(|_| end > 0.0)),
            10 => document.set_exposed_default(&published, value),
            11 | 12 => document.turn(&published, &value.unwrap_or(Value::Null)),
            13 => document.save_variant(&name),
            14 => document.apply_variant(&variant),
            _ => document.rename_variant(&variant, &name) || document.remove_variant(&variant),
        }
    }

    fn stack(&mut self) {
        let Some(stack) = self.dice.pick(&self.document.stacks()) else {
            return;
        };
        let [one, other] = [0, 1].map(|_| self.dice.below(stack.layers.len() + 1));
        match self.dice.below(5) {
            0 => {
                let kind = self.kind();
                self.document.add_layer(&stack.end, one, &kind);
            }
            1 => {
                self.document.remove_layer(&stack.end, one);
            }
            2 => {
                if let Some(layer) = stack.layers.get(one) {
                    self.document.toggle_layer(&layer.node);
                    self.document.set_layer_opacity(&layer.node, other as f64 / 4.0);
                }
            }
            _ => {
                self.document.move_layer(&stack.end, one, other);
            }
        }
    }

    fn keep(&mut self, folder: &Path) {
        let file = ["a.sabi", "deep/a.sabi", "deep/er/b.sabi"][self.dice.below(3)];
        match self.dice.below(4) {
            0 => self.document.save_as(&folder.join(file)).expect("a writable folder"),
            1 => {
                // Without a file there is nothing to save to, which it says.
                let _ = self.document.save();
            }
            _ => {
                self.document.session.keep(&[]).expect("a writable folder");
            }
        }
    }
}
