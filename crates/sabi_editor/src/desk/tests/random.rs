//! Whatever is done in whatever order: nothing panics, all of it can be taken back and done again, and what the desk makes of a
//! graph can be evaluated.

use std::path::Path;

use sabi_graph::UNDO_STEPS;

use super::super::{Align, Merge};
use super::*;

/// Random edits in all, and in how many graphs.
const EDITS: usize = 10_000;
const GRAPHS: usize = 25;

/// SplitMix64, Steele, Lea and Flood 2014.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    fn one_in(&mut self, many: usize) -> bool {
        self.below(many) == 0
    }

    fn pick<T: Clone>(&mut self, from: &[T]) -> Option<T> {
        from.get(self.below(from.len())).cloned()
    }

    fn word(&mut self, from: &[&str]) -> String {
        self.pick(from).unwrap_or_default().to_owned()
    }

    fn place(&mut self) -> [f32; 2] {
        match self.below(200) {
            0 => [f32::NAN, 0.0],
            1 => [f32::MAX, -f32::MAX],
            _ => [0, 1].map(|_| self.below(4000) as f32 - 2000.0),
        }
    }

    /// Values that fit somewhere, and some that fit nowhere.
    fn value(&mut self) -> Option<Value> {
        let text = [
            "", "multiply", "normal", "none", "#ff8000", "../a.png", "a b.png", "v", "\u{7}", "🙂",
        ];
        Some(match self.below(12) {
            0 => return None,
            1 => Value::Null,
            2 => Value::Bool(self.one_in(2)),
            3 => Value::Number(f64::NAN),
            4 => Value::Number(f64::INFINITY),
            5 => Value::Number(-1.0e30),
            6 => Value::Text(self.word(&text)),
            7 => Value::List(
                (0..self.below(5))
                    .map(|_| Value::Number(self.below(9) as f64))
                    .collect(),
            ),
            8 => Value::Object(BTreeMap::from([("x".to_owned(), Value::Null)])),
            _ => Value::Number(self.below(1000) as f64 / 500.0),
        })
    }
}

/// A desk, and hands that know no plan.
struct Hands {
    desk: Desk,
    dice: Dice,
    clipboard: String,
    kinds: Vec<String>,
}

impl Hands {
    fn ids(&self) -> Vec<NodeId> {
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
    fn act(&mut self, folder: &Path) {
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
                self.desk.session.keep().expect("a writable folder");
            }
        }
    }

    /// What holds at any time.
    fn check(&mut self) {
        let text = self.desk.session.text().to_owned();
        let read = Document::from_json(&text);
        assert_eq!(read.as_ref(), Ok(self.desk.document()));
        for node in self.ids() {
            assert!(self.desk.face(&node).is_some());
        }
        assert!(self.desk.selection().iter().all(|node| self.desk.node(node).is_some()));
        self.desk.panel();
        if let Err(error) = self.desk.session.graph().flatten(&Overrides::default()) {
            panic!("{error}\n{text}");
        }
    }

    /// Back to the beginning, and forth again.
    fn check_history(&mut self, empty: &str) {
        self.check();
        let after = self.desk.session.text().to_owned();
        let steps = self.desk.session.undo_names().count();
        assert!(steps < UNDO_STEPS, "all of it can be undone");
        // The last step in view of the desk; what nodes show need not be made for all the others.
        for _ in 1..steps {
            self.desk.session.undo().expect("a step back");
        }
        self.desk.undo();
        assert_eq!(self.desk.session.undo_names().count(), 0);
        assert_eq!(self.desk.session.text(), empty);
        for _ in 1..steps {
            self.desk.session.redo().expect("a step forth");
        }
        self.desk.redo();
        assert_eq!(self.desk.session.text(), after);
        self.desk.take_notices();
    }
}

#[test]
fn ten_thousand_random_edits_can_all_be_taken_back_and_done_again() {
    let kinds: Vec<String> = kinds().1.entries().map(|entry| entry.id.clone()).collect();
    for graph in 0..GRAPHS {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::create_dir_all(folder.path().join("deep/er")).expect("a writable folder");
        let session = Session::new(Some(&folder.path().join("kept")));
        let mut hands = Hands {
            desk: desk_with(session, graph as u64),
            dice: Dice(graph as u64),
            clipboard: String::new(),
            kinds: kinds.clone(),
        };
        let empty = hands.desk.session.text().to_owned();
        for edit in 1..=EDITS / GRAPHS {
            hands.act(folder.path());
            if edit % 20 == 0 {
                hands.check();
            }
            if edit % (EDITS / GRAPHS / 2) == 0 {
                hands.check_history(&empty);
            }
        }
        hands.desk.session.close();
    }
}

#[test]
fn a_long_day_of_edits_takes_no_more_memory_than_a_short_one() {
    let mut desk = desk();
    let node = add(&mut desk, "noise/white");
    for edit in 0..2 * UNDO_STEPS {
        desk.set_knob(&node, "size", number(edit as f64));
        desk.take_notices();
    }
    assert!(desk.session.undo_names().count() <= UNDO_STEPS + UNDO_STEPS / 4);
}
