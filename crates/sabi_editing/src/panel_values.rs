//! What published knobs hold, and what they may hold.

use sabi_graph::{Edit, Exposed, NodeId, SlotRef, Value, canonical_number};

use super::{KnobTarget, OpenDocument};

impl OpenDocument {
    /// Turns a knob of the panel: its default where it has one, else the knobs of nodes that it stands for.
    pub fn turn(&mut self, name: &str, value: &Value) -> bool {
        if let Some(why) = self.why_not_turn(name, value) {
            return self.refuse(why);
        }
        let edits = self.turning(name, value);
        let step = format!("Set {}", name.replace('_', " "));
        self.edit(&step, edits)
    }

    /// Gives a knob of the panel back what it held when the graph was opened.
    pub fn turn_back(&mut self, name: &str) -> bool {
        let mut panel = self.panel().into_iter();
        match panel.find(|knob| knob.name == name) {
            Some(knob) => self.turn(name, &knob.at_first),
            None => self.refuse(format!("there is no knob '{name}' on the panel")),
        }
    }

    /// Sets a knob, wherever it is: on a node also that of all selected ones of its kind.
    pub fn set_at(&mut self, knob: &KnobTarget, value: Value) -> bool {
        match knob {
            KnobTarget::Node { node, knob } => self.set_knob_of_alike(node, knob, Some(value)),
            KnobTarget::Panel(name) => self.turn(name, &value),
        }
    }

    /// Why a knob of the panel cannot be turned there.
    pub(super) fn why_not_turn(&self, name: &str, value: &Value) -> Option<String> {
        let Some(exposed) = self.graph().exposed().get(name) else {
            return Some(format!("there is no knob '{name}' on the panel"));
        };
        left_out(exposed.range, value).map(|why| format!("'{name}' {why}"))
    }

    /// The edits that turn a knob of the panel.
    pub(super) fn turning(&self, name: &str, value: &Value) -> Vec<Edit> {
        let Some(exposed) = self.graph().exposed().get(name) else {
            return Vec::new();
        };
        if exposed.default.is_some() {
            let default = Some(value.clone());
            return vec![self.exposing(
                name,
                Exposed {
                    default,
                    ..exposed.clone()
                },
            )];
        }
        let set = |slot: &SlotRef| Edit::SetParam {
            body: self.body(),
            node: slot.node.clone(),
            param: slot.name.clone(),
            value: Some(value.clone()),
        };
        exposed.to.iter().map(set).collect()
    }

    /// The edit without which turning a node's own knob would do nothing: a published knob with a default sets it as well.
    pub(super) fn published_default(&self, id: &NodeId, knob: &str, value: Option<&Value>) -> Option<Edit> {
        let name = self.exposed_as(id, knob)?;
        let exposed = self
            .graph()
            .exposed()
            .get(name)
            .filter(|exposed| exposed.default.is_some())?;
        let inside = value.filter(|value| left_out(exposed.range, value).is_none());
        // Back to the node's own is without any; what the panel's range leaves out cannot be its default either.
        let default = inside.cloned();
        Some(self.exposing(
            name,
            Exposed {
                default,
                ..exposed.clone()
            },
        ))
    }

    /// Gives a published knob a default of its own, or (`None`) leaves its nodes as they are set.
    pub fn set_exposed_default(&mut self, name: &str, default: Option<Value>) -> bool {
        let Some(exposed) = self.graph().exposed().get(name).cloned() else {
            return self.refuse(format!("there is no knob '{name}' on the panel"));
        };
        if let Some(why) = default.as_ref().and_then(|value| left_out(exposed.range, value)) {
            return self.refuse(format!("'{name}' {why}"));
        }
        let edit = self.exposing(name, Exposed { default, ..exposed });
        self.edit("Set default", vec![edit])
    }

    /// Gives a published knob a range of its own, or (`None`) that of the knob that it turns. What is set already has to lie
    /// in it.
    pub fn set_exposed_range(&mut self, name: &str, range: Option<[f64; 2]>) -> bool {
        let Some(exposed) = self.graph().exposed().get(name).cloned() else {
            return self.refuse(format!("there is no knob '{name}' on the panel"));
        };
        // As the file will have it, so that what lies on its border lies in it.
        let range = range.map(|ends| ends.map(|end| canonical_number(end).unwrap_or(end)));
        let outside = self.set_values(name, &exposed).find_map(|(place, value)| {
            let why = left_out(range, &value)?;
            Some(format!("{place} would lie outside: '{name}' {why}"))
        });
        if let Some(why) = outside {
            return self.refuse(why);
        }
        let edit = self.exposing(name, Exposed { range, ..exposed });
        self.edit("Set range", vec![edit])
    }

    /// All that a published knob is set to, each with where.
    fn set_values<'d>(&'d self, name: &'d str, exposed: &'d Exposed) -> impl Iterator<Item = (String, Value)> + 'd {
        let default = exposed
            .default
            .iter()
            .map(|value| ("its default".to_owned(), value.clone()));
        let variants = self.graph().variants().iter();
        let variants = variants
            .filter_map(move |(variant, values)| Some((format!("the variant '{variant}'"), values.get(name)?.clone())));
        let instances = self.instances_of_seen().into_iter();
        let instances = instances.filter_map(move |(_, id, node)| {
            let title = node.label.clone().unwrap_or_else(|| id.to_string());
            Some((format!("the instance '{title}'"), node.params.get(name)?.clone()))
        });
        default.chain(variants).chain(instances)
    }
}

/// Why a range leaves a value out.
fn left_out(range: Option<[f64; 2]>, value: &Value) -> Option<String> {
    let [low, high] = range?;
    let one = std::slice::from_ref(value);
    for part in value.as_list().unwrap_or(one) {
        match part.as_number() {
            Some(number) if (low..=high).contains(&number) => {}
            Some(number) => return Some(format!("takes {low} to {high}, and this is {number}")),
            None => return Some(format!("takes numbers from {low} to {high}, and this is none")),
        }
    }
    None
}
