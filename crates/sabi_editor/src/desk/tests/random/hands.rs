//! Hands that know no plan: each does one thing after another to a desk.

use std::path::Path;

use super::super::super::{Align, Merge};
use super::super::*;
use super::dice::Dice;

/// A desk, and hands that know no plan.
pub(super) struct Hands {
    pub(super) desk: Desk,
    pub(super) dice: Dice,
    pub(super) clipboard: String,
    pub(super) kinds: Vec<String>,
}

impl Hands {
    pub(super) fn ids(&self) -> Vec<NodeId> {
        self.desk.graph().ids().cloned().collect()
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
        let face = self.desk.face(&node).cloned();
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
        let face = self.desk.face(&node).cloned();
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
        let face = self.desk.face(&node).cloned();
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
        let names: Vec<String> = self.desk.document().groups.keys().cloned().collect();
        self.dice.pick(&names).unwrap_or_else(|| "Group".to_owned())
    }

    fn published(&mut self) -> String {
        let names: Vec<String> = self.desk.graph().exposed().keys().cloned().collect();
        self.dice.pick(&names).unwrap_or_else(|| "nothing".to_owned())
    }

    fn name(&mut self) -> String {
        self.dice.word(&[
            "", "a", "b", "size", "seed", "none", "v", "Dust", "x.sabi", "a.b", " c ",
        ])
    }

    fn loose(&mut self) -> Option<Loose> {
        match self.dice.below(3) {
            0 => None,
            1 => Some(Loose::From(self.output())),
            _ => Some(Loose::Into(self.input())),
        }
    }

    /// Does one thing.
    pub(super) fn act(&mut self, folder: &Path) {
        match self.dice.below(24) {
            0..=4 => {
                let (kind, pos, loose) = (self.kind(), self.dice.place(), self.loose());
                self.desk.add(&kind, pos, loose.as_ref());
            }
            5..=7 => {
                self.wire();
            }
            8 | 9 => {
                self.turn();
            }
            10 | 11 => {
                let ids: Vec<NodeId> = self.ids().into_iter().filter(|_| self.dice.one_in(3)).collect();
                self.desk.select(ids);
                if self.dice.one_in(8) {
                    self.desk.select_stream(self.dice.one_in(2));
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
                        true => self.desk.undo(),
                        false => self.desk.redo(),
                    }
                }
            }
            _ => self.keep(folder),
        }
    }

    fn wire(&mut self) -> bool {
        let (from, to) = (self.output(), self.input());
        match self.dice.below(12) {
            0 => self.desk.cut(&[to]),
            1 => {
                let node = self.id();
                let may = self.desk.may_insert(&node, &to);
                assert_eq!(self.desk.insert(&node, &to), may);
                may
            }
            2 => self.desk.reroute(&to, self.dice.place()),
            3 => {
                let (_, how) = self.dice.pick(&Merge::OFFERED).unwrap_or(Merge::OFFERED[0]);
                self.desk.may_merge(&from, &to);
                self.desk.merge(&from, &to, how)
            }
            4 => self.desk.swap_inputs(),
            5 => self.desk.take_out(),
            _ => {
                let fits = self.desk.fits(&from, &to).is_ok();
                assert_eq!(self.desk.connect(&from, &to), fits, "{from} into {to}");
                fits
            }
        }
    }

    fn turn(&mut self) -> bool {
        let ((node, knob), value) = (self.knob(), self.dice.value());
        match self.dice.below(4) {
            0 => {
                self.desk.session.begin("Drag");
                for _ in 0..5 {
                    let value = self.dice.value();
                    self.desk.set_knob(&node, &knob, value);
                }
                self.desk.session.end();
                true
            }
            1 => self.desk.set_knob_of_alike(&node, &knob, value),
            _ => self.desk.set_knob(&node, &knob, value),
        }
    }

    fn change_nodes(&mut self) -> bool {
        match self.dice.below(12) {
            0 => self.desk.delete(self.dice.one_in(2)),
            1 => self.desk.mute(),
            2 => self.desk.duplicate(self.dice.one_in(2)),
            3 => {
                let (node, kind) = (self.id(), self.kind());
                self.desk.replace(&node, &kind)
            }
            4 => {
                let (node, name) = (self.id(), self.name());
                self.desk.rename(&node, &name)
            }
            5 => {
                self.clipboard = self.desk.copied().unwrap_or_default();
                true
            }
            6 => {
                self.clipboard = self.desk.cut_out().unwrap_or_default();
                true
            }
            7 | 8 => {
                let pos = self.dice.place();
                self.desk.paste(&self.clipboard.clone(), pos)
            }
            9 => self.desk.frame(),
            10 => {
                let frames: Vec<String> = self.desk.graph().frames().keys().cloned().collect();
                let frame = self.dice.pick(&frames).unwrap_or_default();
                let nodes = self.desk.selection().clone();
                match self.dice.below(3) {
                    0 => self.desk.remove_frame(&frame),
                    1 => self.desk.put_into_frame(&nodes, None),
                    _ => self.desk.put_into_frame(&nodes, Some(&frame)),
                }
            }
            _ => self.desk.delete(true),
        }
    }

    fn change_groups(&mut self) -> bool {
        let (group, name, input, output) = (self.group(), self.name(), self.input(), self.output());
        let of = |names: Vec<&String>, dice: &mut Dice| dice.pick(&names).cloned().unwrap_or_default();
        let port_in = of(self.desk.group_inputs().keys().collect(), &mut self.dice);
        let port_out = of(self.desk.group_outputs().keys().collect(), &mut self.dice);
        match self.dice.below(16) {
            0 | 1 => self.desk.make_group(),
            2 => self.desk.dissolve_groups(),
            3..=5 => {
                let instances: Vec<NodeId> = self.ids();
                let is_instance = |id: &NodeId| self.desk.node(id).is_some_and(|node| node.group.is_some());
                let instances: Vec<NodeId> = instances.into_iter().filter(is_instance).collect();
                let instance = self.dice.pick(&instances);
                instance.is_some_and(|instance| self.desk.enter(&instance))
            }
            6 | 7 => self.desk.leave(),
            8 => {
                let (pos, loose) = (self.dice.place(), self.loose());
                self.desk.add_group_instance(&group, pos, loose.as_ref()).is_some()
            }
            9 => self.desk.rename_group(&group, &name),
            10 => self.desk.publish_input(&input).is_some(),
            11 => self.desk.publish_output(&output).is_some(),
            12 => self.desk.feed(&port_in, &input) || self.desk.unfeed(&input),
            13 => self.desk.rename_input(&port_in, &name) || self.desk.rename_output(&port_out, &name),
            14 => self.desk.retarget_output(&port_out, &output) || self.desk.label_input(&port_in, &name),
            _ => match self.dice.one_in(2) {
                true => self.desk.remove_input(&port_in),
                false => self.desk.remove_output(&port_out),
            },
        }
    }

    fn arrange(&mut self) -> bool {
        match self.dice.below(5) {
            0 => self
                .desk
                .align([Align::Left, Align::Right, Align::Top, Align::Bottom][self.dice.below(4)]),
            1 => self.desk.straighten(),
            2 => self.desk.lay_out(),
            _ => {
                let places = self.desk.places().into_keys().map(|id| (id, self.dice.place()));
                let places = places.collect();
                self.desk.move_to("Move", places)
            }
        }
    }

    fn publish(&mut self) -> bool {
        let ((node, knob), name, published) = (self.knob(), self.name(), self.published());
        let (value, end) = (self.dice.value(), self.dice.below(4) as f64);
        let variants: Vec<String> = self.desk.graph().variants().keys().cloned().collect();
        let variant = self.dice.pick(&variants).unwrap_or_default();
        let desk = &mut self.desk;
        match self.dice.below(16) {
            0..=3 => desk.expose(&node, &knob),
            4 => desk.unexpose(&published),
            5 => desk.expose_as(&node, &knob, &published) || desk.take_off_panel(&node, &knob),
            6 => desk.rename_exposed(&published, &name),
            7 => desk.label_exposed(&published, &name) && desk.set_section(&published, &name),
            8 => desk.move_exposed(&published, Some(&name)),
            9 => desk.set_exposed_range(&published, Some([0.0, end]).filter(|_| end > 0.0)),
            10 => desk.set_exposed_default(&published, value),
            11 | 12 => desk.turn(&published, &value.unwrap_or(Value::Null)),
            13 => desk.save_variant(&name),
            14 => desk.apply_variant(&variant),
            _ => desk.rename_variant(&variant, &name) || desk.remove_variant(&variant),
        }
    }

    fn stack(&mut self) {
        let Some(stack) = self.dice.pick(&self.desk.stacks()) else {
            return;
        };
        let [one, other] = [0, 1].map(|_| self.dice.below(stack.layers.len() + 1));
        match self.dice.below(5) {
            0 => {
                let kind = self.kind();
                self.desk.add_layer(&stack.end, one, &kind);
            }
            1 => {
                self.desk.remove_layer(&stack.end, one);
            }
            2 => {
                if let Some(layer) = stack.layers.get(one) {
                    self.desk.toggle_layer(&layer.node);
                    self.desk.set_layer_opacity(&layer.node, other as f64 / 4.0);
                }
            }
            _ => {
                self.desk.move_layer(&stack.end, one, other);
            }
        }
    }

    fn keep(&mut self, folder: &Path) {
        let file = ["a.sabi", "deep/a.sabi", "deep/er/b.sabi"][self.dice.below(3)];
        match self.dice.below(4) {
            0 => self.desk.save_as(&folder.join(file)).expect("a writable folder"),
            1 => {
                // Without a file there is nothing to save to, which it says.
                let _ = self.desk.save();
            }
            _ => {
                self.desk.session.keep(&[]).expect("a writable folder");
            }
        }
    }
}
