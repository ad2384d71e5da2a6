//! Rules for every document, checked when it is read and edited.

use std::collections::BTreeMap;

use crate::document::{Fit, GroupDef, GroupInput, SavedView};
use crate::graph::ExposedParameter;
use crate::id_text::check_port_name;
use crate::name::{NOT_IN_KNOBS, check_name};
use crate::problem::{Problem, hint, quoted};
use crate::{GROUP_KIND, Graph, Node, SlotRef, Value};

/// Returns true if the name of a group is the path of a group file.
pub(crate) fn is_group_file(name: &str) -> bool {
    name.ends_with(".sabi")
}

/// Checks that a node has a kind, and that a group instance names an existing group.
pub(crate) fn kind_and_group<'a>(
    node: &Node,
    is_group: impl Fn(&str) -> bool,
    groups: impl IntoIterator<Item = &'a str>,
) -> Result<(), Problem> {
    if node.kind.is_empty() {
        return Err(Problem::NoKind);
    }
    if node.kind != GROUP_KIND {
        return Ok(());
    }
    match &node.group {
        None => Err(Problem::GroupNotNamed),
        Some(name) if is_group(name) || is_group_file(name) => Ok(()),
        Some(name) => Err(Problem::NoSuchGroup {
            name: quoted(name),
            hint: hint(name, groups),
        }),
    }
}

/// Checks the name and the range of a knob, and that it sets parameters of existing nodes.
pub(crate) fn knob(graph: &Graph, name: &str, knob: &ExposedParameter) -> Result<(), Problem> {
    check_name("knob", name, NOT_IN_KNOBS)?;
    slots(graph, &knob.to)?;
    if let Some(slot) = knob.curves.keys().find(|slot| !knob.to.contains(slot)) {
        return Err(Problem::StrayCurve {
            knob: quoted(name),
            slot: slot.to_string(),
        });
    }
    if !knob.curves.is_empty() && knob.default.as_ref().and_then(Value::as_number).is_none() {
        return Err(Problem::CurveWithoutDefault { knob: quoted(name) });
    }
    match knob.range {
        // This comparison also refuses NaN.
        Some([low, high]) if !(low <= high && low.is_finite() && high.is_finite()) => {
            Err(Problem::EmptyRange { knob: quoted(name) })
        }
        _ => Ok(()),
    }
}

fn slots(graph: &Graph, slots: &[SlotRef]) -> Result<(), Problem> {
    for slot in slots {
        graph.find(slot.node.as_str())?;
        if slot.name.is_empty() {
            return Err(Problem::BadSlot {
                text: quoted(&slot.to_string()),
            });
        }
    }
    Ok(())
}

/// Checks that a variant sets an exposed knob.
pub(crate) fn variant_sets(graph: &Graph, variant: &str, knob: &str) -> Result<(), Problem> {
    if graph.exposed().contains_key(knob) {
        return Ok(());
    }
    Err(Problem::NotExposed {
        variant: quoted(variant),
        knob: quoted(knob),
        hint: hint(knob, graph.exposed().keys().map(String::as_str)),
    })
}

/// Checks that an input of a group feeds existing inputs of nodes, and that no other input of the group feeds them.
pub(crate) fn group_input(graph: &Graph, fed: &mut FedInputs, name: &str, input: &GroupInput) -> Result<(), Problem> {
    check_port_name(name)?;
    slots(graph, &input.to)?;
    for slot in &input.to {
        check_port_name(&slot.name)?;
        if let Some(first) = fed.insert(slot.clone(), name.to_owned()) {
            return Err(Problem::FedTwice {
                first,
                second: name.to_owned(),
                slot: slot.to_string(),
            });
        }
    }
    Ok(())
}

/// Inputs of nodes inside a group, each with the group input that feeds it.
pub(crate) type FedInputs = BTreeMap<SlotRef, String>;

/// Checks the inputs and outputs of a group against its graph.
pub(crate) fn group_ports(group: &GroupDef) -> Result<(), Problem> {
    let mut fed = FedInputs::new();
    for (name, input) in &group.inputs {
        group_input(&group.graph, &mut fed, name, input)?;
    }
    for (name, from) in &group.outputs {
        check_port_name(name)?;
        from.port.as_deref().map_or(Ok(()), check_port_name)?;
        group.graph.find(from.node.as_str())?;
    }
    Ok(())
}

/// Returns the canonical form of a fit; `None` for a length that is not above zero.
pub(crate) fn fit(fit: Fit) -> Option<Fit> {
    match fit {
        Fit::Length(metres) => crate::canonical_number(metres)
            .filter(|metres| *metres > 0.0)
            .map(Fit::Length),
        other => Some(other),
    }
}

/// Checks the names of views and converts their numbers to canonical form.
pub(crate) fn views(views: &mut BTreeMap<String, SavedView>) -> Result<(), Problem> {
    for (name, view) in views {
        check_name("view", name, "")?;
        let [x, y, z] = &mut view.target;
        for number in [x, y, z, &mut view.yaw, &mut view.pitch, &mut view.distance] {
            let bad = || Problem::BadValue { name: quoted("views") };
            *number = crate::canonical_number(*number).ok_or_else(bad)?;
        }
    }
    Ok(())
}
