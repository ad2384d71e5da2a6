//! Random documents and edits.

use std::collections::BTreeMap;

use proptest::prelude::*;

use crate::document::{Fit, GroupDef, GroupInput, Preview, SavedView};
use crate::graph::{ExposedParameter, Frame};
use crate::{
    Body, Document, Edit, GROUP_KIND, KnobCurve, Node, NodeDisplay, NodeId, NodeRows, Note, OutputRef, PortType,
    SlotRef, Value,
};

/// Generates ids from a small set, so that edits often refer to the same nodes.
fn a_node_id() -> impl Strategy<Value = NodeId> {
    prop::sample::select(vec!["a", "b", "c", "d_1", "e_2", "f"]).prop_map(|id| id.parse().unwrap())
}

fn a_port() -> impl Strategy<Value = String> {
    prop::sample::select(vec!["mask", "source", "base", "Ünicode port"]).prop_map(str::to_owned)
}

fn a_name() -> impl Strategy<Value = String> {
    prop::sample::select(vec!["amount", "wear", "heavy", "x y"]).prop_map(str::to_owned)
}

fn a_body() -> impl Strategy<Value = Body> {
    prop_oneof![3 => Just(Body::Main), 2 => a_name().prop_map(Body::Group)]
}

fn a_number() -> impl Strategy<Value = f64> {
    let any_float = any::<f32>()
        .prop_filter("finite", |x| x.is_finite())
        .prop_map(f64::from);
    prop_oneof![
        any_float,
        (-1000..1000i32).prop_map(f64::from),
        any::<u32>().prop_map(f64::from),
        -1.0..1.0f64
    ]
}

fn a_value() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::Bool),
        a_number().prop_map(Value::Number),
        any::<String>().prop_map(Value::Text),
    ];
    leaf.prop_recursive(3, 12, 4, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..4).prop_map(Value::List),
            prop::collection::btree_map(any::<String>(), inner, 0..4).prop_map(Value::Object),
        ]
    })
}

fn values() -> impl Strategy<Value = BTreeMap<String, Value>> {
    prop::collection::btree_map("x-[a-z]{1,5}", a_value(), 0..3)
}

fn an_output() -> impl Strategy<Value = OutputRef> {
    (a_node_id(), prop::option::of(a_port())).prop_map(|(node, port)| OutputRef { node, port })
}

fn slots() -> impl Strategy<Value = Vec<SlotRef>> {
    prop::collection::vec(
        (a_node_id(), a_port()).prop_map(|(node, name)| SlotRef { node, name }),
        0..3,
    )
}

fn a_node() -> impl Strategy<Value = Node> {
    let kind = prop::sample::select(vec![
        "noise/simplex",
        "adjust/levels@2",
        "graph/reroute",
        "not/known",
        GROUP_KIND,
    ]);
    let named = (kind, prop::option::of(any::<String>()), prop::option::of(a_name()));
    (
        named,
        values(),
        any::<[i16; 2]>(),
        (any::<bool>(), a_display()),
        values(),
    )
        .prop_map(|((kind, label, group), params, pos, (muted, display), extra)| Node {
            kind: kind.to_owned(),
            params,
            pos: pos.map(|x| f32::from(x) / 10.0),
            muted,
            display,
            label,
            group,
            extra,
        })
}

fn a_display() -> impl Strategy<Value = NodeDisplay> {
    let rows = prop::sample::select(vec![NodeRows::All, NodeRows::Wired, NodeRows::None]);
    (rows, any::<bool>()).prop_map(|(rows, has_named_wires)| NodeDisplay { rows, has_named_wires })
}

fn a_note() -> impl Strategy<Value = Note> {
    let place = (any::<[i16; 2]>(), any::<u8>());
    (any::<String>(), place, prop::option::of(any::<String>()), values()).prop_map(
        |(text, (pos, width), color, extra)| Note {
            text,
            pos: pos.map(f32::from),
            width: f32::from(width),
            color,
            extra,
        },
    )
}

fn a_view() -> impl Strategy<Value = SavedView> {
    let target = [a_number(), a_number(), a_number()];
    (target, a_number(), a_number(), a_number(), any::<bool>()).prop_map(
        |(target, yaw, pitch, distance, is_parallel)| SavedView {
            target,
            yaw,
            pitch,
            distance,
            is_parallel,
            extra: BTreeMap::from([("newer".to_owned(), Value::Bool(is_parallel))]),
        },
    )
}

fn a_knob() -> impl Strategy<Value = ExposedParameter> {
    let range = prop::option::of((-10.0..0.0f64, 0.0..10.0f64).prop_map(|(low, high)| [low, high]));
    let words = (prop::option::of(any::<String>()), prop::option::of(any::<String>()));
    let heights = prop::collection::vec(a_number(), 2..5);
    let place = (prop::option::of(any::<String>()), prop::option::of(any::<u32>()));
    let told = (words, place);
    let set = (slots(), prop::option::of(heights));
    (set, told, range, prop::option::of(a_value()), values()).prop_map(
        |((to, heights), ((label, about), (section, order)), range, default, extra)| {
            let points = heights.map(|heights| (0..).map(f64::from).zip(heights).map(|(at, height)| [at, height]));
            // A knob with curves has a number as its default.
            let curve = points.filter(|_| default.as_ref().and_then(Value::as_number).is_some());
            let curve = curve.and_then(|points| KnobCurve::new(points.collect()));
            ExposedParameter {
                curves: to.first().cloned().zip(curve).into_iter().collect(),
                to,
                label,
                about,
                section,
                order,
                range,
                default,
                extra,
            }
        },
    )
}

fn an_input() -> impl Strategy<Value = GroupInput> {
    let ty = prop::option::of(prop::sample::select(PortType::ALL.to_vec()));
    (slots(), ty, prop::option::of(any::<String>()), values()).prop_map(|(to, ty, label, extra)| GroupInput {
        to,
        ty,
        label,
        extra,
    })
}

fn a_frame() -> impl Strategy<Value = Frame> {
    let words = || prop::option::of(any::<String>());
    (words(), words(), prop::collection::vec(a_node_id(), 0..4), values()).prop_map(|(title, color, nodes, extra)| {
        Frame {
            title,
            color,
            nodes,
            extra,
        }
    })
}

fn a_fit() -> impl Strategy<Value = Fit> {
    prop_oneof![
        Just(Fit::Unit),
        Just(Fit::Metres),
        Just(Fit::Piece),
        a_number().prop_map(Fit::Length)
    ]
}

fn a_preview() -> impl Strategy<Value = Preview> {
    (
        [prop::option::of(any::<String>()), prop::option::of(any::<String>())],
        prop::collection::vec(any::<String>(), 0..3),
        prop::collection::vec(any::<String>(), 0..3),
        any::<bool>(),
        prop::option::of(any::<u32>()),
        prop::option::of(any::<String>()),
        prop::collection::btree_map(a_name(), a_view(), 0..3),
        values(),
    )
        .prop_map(
            |([mesh, textures], parts, without, turn_faces, size, variant, views, extra)| Preview {
                mesh,
                textures,
                parts,
                without,
                turn_faces,
                size,
                variant,
                views,
                extra,
            },
        )
}

fn a_group() -> impl Strategy<Value = GroupDef> {
    (prop::option::of(any::<String>()), prop::option::of(a_fit()), values()).prop_map(|(name, fit, extra)| GroupDef {
        name,
        fit,
        extra,
        ..GroupDef::default()
    })
}

/// One of the edits of nodes and links.
fn a_node_edit() -> impl Strategy<Value = Edit> {
    let place = || (a_body(), a_node_id());
    let links = || prop::collection::btree_map(a_port(), an_output(), 0..3);
    prop_oneof![
        6 => (place(), a_node(), links())
            .prop_map(|((body, id), node, inputs)| Edit::AddNode { body, id, node, inputs }),
        2 => place().prop_map(|(body, id)| Edit::RemoveNode { body, id }),
        2 => (place(), a_port(), prop::option::of(a_value()))
            .prop_map(|((body, node), param, value)| Edit::SetParam { body, node, param, value }),
        5 => (place(), a_port(), an_output())
            .prop_map(|((body, node), input, from)| Edit::Connect { body, node, input, from }),
        1 => (place(), a_port()).prop_map(|((body, node), input)| Edit::Disconnect { body, node, input }),
        1 => (place(), any::<[f32; 2]>()).prop_map(|((body, node), pos)| Edit::Move { body, node, pos }),
        1 => (place(), any::<bool>()).prop_map(|((body, node), muted)| Edit::SetMuted { body, node, muted }),
        1 => (place(), a_display()).prop_map(|((body, node), display)| Edit::SetDisplay { body, node, display }),
        1 => (place(), prop::option::of(any::<String>()))
            .prop_map(|((body, node), label)| Edit::SetLabel { body, node, label }),
    ]
}

/// Generates an edit of exposed knobs, the variants, the ports or the frames.
fn an_exposed_edit() -> impl Strategy<Value = Edit> {
    let place = || (a_body(), a_name());
    let settings = || prop::option::of(prop::collection::btree_map(a_name(), a_value(), 0..3));
    prop_oneof![
        (place(), a_frame()).prop_map(|((body, id), frame)| Edit::AddFrame { body, id, frame }),
        (place(), prop::option::of(a_note())).prop_map(|((body, id), note)| Edit::SetNote { body, id, note }),
        place().prop_map(|(body, id)| Edit::RemoveFrame { body, id }),
        (place(), a_knob()).prop_map(|((body, name), knob)| Edit::Expose { body, name, knob }),
        place().prop_map(|(body, name)| Edit::Unexpose { body, name }),
        (place(), settings()).prop_map(|((body, name), values)| Edit::SetVariant { body, name, values }),
        (place(), prop::option::of(an_input())).prop_map(|((body, name), input)| Edit::SetInput { body, name, input }),
        (place(), prop::option::of(an_output())).prop_map(|((body, name), output)| Edit::SetOutput {
            body,
            name,
            output
        }),
        (a_name(), a_group()).prop_map(|(name, group)| Edit::SetGroup {
            name,
            group: Box::new(group),
        }),
        (a_name(), a_group()).prop_map(|(name, group)| Edit::AddGroup {
            name,
            group: Box::new(group)
        }),
        a_name().prop_map(|name| Edit::RemoveGroup { name }),
        (a_name(), a_name(), prop::option::of(any::<String>())).prop_map(|(name, to, shown)| Edit::RenameGroup {
            name,
            to,
            shown
        }),
        any::<String>().prop_map(|name| Edit::RenameDocument { name }),
        prop::option::of(a_preview()).prop_map(|preview| Edit::SetPreview { preview }),
        a_fit().prop_map(|fit| Edit::SetFit { fit }),
        any::<u32>().prop_map(|seed| Edit::SetSeed { seed }),
    ]
}

/// Generates any edit. Many of them do not fit a given document.
pub(super) fn an_edit() -> impl Strategy<Value = Edit> {
    let one = || prop_oneof![3 => a_node_edit(), 2 => an_exposed_edit()];
    prop_oneof![8 => one(), 1 => prop::collection::vec(one(), 0..4).prop_map(Edit::Batch)]
}

/// Generates a document by random edits.
pub(super) fn a_document() -> impl Strategy<Value = Document> {
    (prop::collection::vec(an_edit(), 0..60), values()).prop_map(|(edits, extra)| {
        // Values are stored in their canonical form.
        let kept = |(key, value): (String, Value)| Some((key, value.canonical()?));
        let mut document = Document {
            extra: extra.into_iter().filter_map(kept).collect(),
            ..Document::default()
        };
        for edit in edits {
            let _ = document.apply(edit);
        }
        document
    })
}
