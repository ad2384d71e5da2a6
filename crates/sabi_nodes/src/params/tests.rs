use std::path::PathBuf;

use crate::kind::{Memory, Param, ParamValue, Role};
use crate::{Libraries, Library, SourceFile, read_kind};

/// Reads a node with these members of `struct Params`; `uses` uses them all. Returns the parameters or the first message.
fn read(members: &str, uses: &str) -> Result<Vec<Param>, String> {
    let text = format!(
        "//! Test\n//! A test.\n\nstruct Params {{\n{members}\n}}\n\n/// The mask.\nfn mask(params: Params) -> f32 {{\n    return f32({uses});\n}}\n"
    );
    let core = Library::builtin_files().1.text("core").unwrap().to_owned();
    let libraries = Libraries([("core".to_owned(), core)].into());
    let file = SourceFile {
        path: PathBuf::from("test/node.wgsl"),
        id: "test/node".to_owned(),
        text,
    };
    read_kind(&file, &libraries)
        .map(|kind| kind.params)
        .map_err(|faults| faults[0].message.clone())
}

fn one(member: &str, uses: &str) -> Result<Param, String> {
    read(&format!("/// Doc.\n{member}"), uses).map(|mut params| params.remove(0))
}

#[test]
fn types_and_offsets_are_read_from_the_code() {
    let params = read(
        "/// A.\n/// @default 1\na: f32,\n/// B.\n/// @default 1 2 3\nb: vec3f,\n/// C.\n/// @default -3\nc: i32,\n/// D.\n/// @default 7\nd: u32,\n/// E.\n/// @default 1 2\ne: vec2f,\n/// F.\n/// @default 1 2 3 4\nf: vec4f,",
        "params.a + params.b.x + f32(params.c) + f32(params.d) + params.e.x + params.f.w",
    )
    .unwrap();
    let found: Vec<(Memory, u32)> = params.iter().map(|param| (param.ty.memory, param.offset)).collect();
    assert_eq!(
        found,
        [
            (Memory::F32, 0),
            (Memory::Vec3, 16),
            (Memory::I32, 28),
            (Memory::U32, 32),
            (Memory::Vec2, 40),
            (Memory::Vec4, 48)
        ]
    );
    assert_eq!(params[2].default, ParamValue::Signed(-3));
    assert_eq!(params[3].default, ParamValue::Unsigned(7));
    assert_eq!(params[4].default, ParamValue::Floats(vec![1.0, 2.0]));
}

#[test]
fn every_annotation_is_read() {
    let param = one("/// More.\n///\n/// Last.\n/// @length @range 0 2 @soft 0.5 1 @default 0.75 @label Big tile @was size extent\ntile_size: f32,", "params.tile_size").unwrap();
    assert_eq!(param.doc, "Doc. More.\n\nLast.");
    assert_eq!(param.ty.role, Role::Length);
    assert_eq!((param.ty.range, param.ty.soft), (Some([0.0, 2.0]), Some([0.5, 1.0])));
    assert_eq!(param.default, ParamValue::Floats(vec![0.75]));
    assert_eq!(param.label, "Big tile");
    assert_eq!(param.formerly, ["size", "extent"]);
    assert!(!param.bounds_a_loop);
}

#[test]
fn a_name_becomes_a_label() {
    assert_eq!(
        one("/// @default 0\ntile_size: f32,", "params.tile_size")
            .unwrap()
            .label,
        "Tile size"
    );
}

#[test]
fn roles_are_read() {
    let role = |member: &str, uses: &str| one(member, uses).map(|param| (param.ty.role, param.default));
    assert_eq!(
        role("/// @toggle @default on\na: u32,", "params.a").unwrap(),
        (Role::Toggle, ParamValue::Unsigned(1))
    );
    assert_eq!(
        role("/// @choice soft hard\n/// @default hard\na: u32,", "params.a").unwrap(),
        (
            Role::Choice(vec!["soft".to_owned(), "hard".to_owned()]),
            ParamValue::Unsigned(1)
        )
    );
    assert_eq!(
        role("/// @choice soft\n/// hard @default soft\na: u32,", "params.a")
            .unwrap()
            .0,
        Role::Choice(vec!["soft".to_owned(), "hard".to_owned()])
    );
    assert_eq!(
        role("/// @seed\na: u32,", "params.a").unwrap(),
        (Role::Seed, ParamValue::Unsigned(0))
    );
    assert_eq!(
        role("/// @seed @default 7\na: u32,", "params.a").unwrap().1,
        ParamValue::Unsigned(7)
    );
    assert_eq!(
        role("/// @angle @range 0 180 @default 60\na: f32,", "params.a").unwrap(),
        (Role::Angle, ParamValue::Floats(vec![60.0]))
    );
    assert_eq!(role("/// @default 0\na: f32,", "params.a").unwrap().0, Role::Plain);
}

#[test]
fn colors_are_stored_linear() {
    let param = one("/// @color @default #ff8000\na: vec3f,", "params.a.x + params.a.y").unwrap();
    let ParamValue::Floats(color) = param.default else {
        panic!("floats")
    };
    assert_eq!((param.ty.role, color[0], color[2]), (Role::Color, 1.0, 0.0));
    assert!((color[1] - 0.215_860_53).abs() < 1e-6, "{}", color[1]);
}

#[test]
fn unused_stops_have_a_position_behind_the_end() {
    let param = one(
        "/// @default 0 #000000 0.5 #ffffff\na: array<vec4f, 3>,",
        "params.a[1].x",
    )
    .unwrap();
    assert_eq!((param.ty.memory, param.ty.role), (Memory::Points(3), Role::Stops));
    assert_eq!(
        param.default,
        ParamValue::Floats(vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.5, 0.0, 0.0, 0.0, 2.0])
    );
}

#[test]
fn a_curve_has_points_with_slopes() {
    let param = one(
        "/// @curve @range -1 1 @default 0 0 1 0.5\na: array<vec4f, 3>,",
        "params.a[1].x",
    )
    .unwrap();
    assert_eq!((param.ty.memory, param.ty.role), (Memory::Points(3), Role::Curve));
    assert_eq!(
        param.default,
        ParamValue::Floats(vec![0.0, 0.0, 0.5, 1.0, 1.0, 0.5, 0.5, 1.0, 1.0, 0.5, 0.0, 0.0])
    );
}

#[test]
fn the_extent_of_the_model_is_taken_along_the_direction_of_a_parameter() {
    let params = read(
        "/// Way.\n/// @default 0 1 0\nalong: vec3f,\n/// End.\n/// @extent high along\nhigh: f32,",
        "params.along.x + params.high",
    )
    .unwrap();
    let role = Role::Extent {
        along: "along".to_owned(),
        high: true,
    };
    assert_eq!(params[1].ty.role, role);
}

#[test]
fn a_length_may_be_absolute() {
    let param = |annotations: &str| one(&format!("/// {annotations} @default 0\na: f32,"), "params.a").unwrap();
    assert!(param("@length @absolute").is_absolute);
    assert!(!param("@length").is_absolute);
}

#[test]
fn annotations_in_backticks_are_text() {
    let param = one("/// Like `@range` and a@b.\n/// @default 0\na: f32,", "params.a").unwrap();
    assert_eq!(param.doc, "Doc. Like `@range` and a@b.");
}

#[test]
fn annotations_that_do_not_suit_the_type_are_refused() {
    for (member, part) in [
        ("/// @default 0\nA: f32,", "cannot be the name"),
        ("/// @default 0\na: vec2<u32>,", "cannot be the type"),
        ("/// @default 0\na: array<vec4f, 17>,", "cannot be the type"),
        ("/// @default 0\na: mat3x3f,", "cannot be the type"),
        ("/// @default x\na: f32,", "one number"),
        ("/// @default 1 2\na: vec3f,", "3 numbers"),
        ("/// @default nan\na: f32,", "one number"),
        ("/// @default 1e99\na: f32,", "one number"),
        ("/// @default 1.5\na: u32,", "whole number"),
        ("/// @default -1\na: u32,", "whole number"),
        ("/// @default 3000000000\na: i32,", "whole number"),
        ("/// @range 0 inf @default 0\na: f32,", "two numbers"),
        ("/// @range 0 1.5 @default 0\na: u32,", "takes whole numbers"),
        ("/// @range -1 1 @default 0\na: u32,", "takes whole numbers"),
        ("/// @range 0 1 @default 2\na: u32,", "outside"),
        ("/// @range 0 1 @default 0 2\na: vec2f,", "outside"),
        ("/// @range 0 1 @toggle @default on\na: u32,", "does not belong"),
        ("/// @toggle @default maybe\na: u32,", "`on` or `off`"),
        ("/// @toggle now @default on\na: u32,", "nothing behind"),
        ("/// @choice one @default one\na: u32,", "two words"),
        ("/// @choice one one @default one\na: u32,", "twice"),
        ("/// @choice one Two @default one\na: u32,", "cannot be a choice"),
        ("/// @seed @default 1\na: f32,", "must be of type `u32`"),
        ("/// @default 0 @default 1\na: f32,", "twice"),
        ("/// @default 0 @label\na: f32,", "gives no name"),
        ("/// @default 2 #000000\na: array<vec4f, 4>,", "stops"),
        ("/// @default\na: array<vec4f, 4>,", "stops"),
        (
            "/// @default 0 #000000 1 #000000 1 #000000\na: array<vec4f, 2>,",
            "stops",
        ),
        (
            "/// @curve @default 0 0 1 1\na: vec4f,",
            "must be of type `array<vec4f, 16>`",
        ),
        ("/// @curve @default 0 0 1\na: array<vec4f, 4>,", "pairs of numbers"),
        ("/// @curve @default 1 0 0 1\na: array<vec4f, 4>,", "x growing"),
        ("/// @curve @default 0 0 1 1 2 2\na: array<vec4f, 2>,", "1 to 2 points"),
        ("/// @curve @range 0 1 @default 0 0 1 2\na: array<vec4f, 2>,", "outside"),
        ("/// @curve @default 0 0 1 2000\na: array<vec4f, 2>,", "outside"),
        ("/// @absolute @default 0\na: f32,", "beside `@length`"),
        ("/// @angle @absolute @default 0\na: f32,", "beside `@length`"),
        ("/// @length @absolute now @default 0\na: f32,", "beside `@length`"),
        ("/// @extent up a\na: f32,", "`low` or `high`"),
        ("/// @extent low a @default 0\na: f32,", "`low` or `high`"),
    ] {
        let message = one(member, "1").unwrap_err();
        assert!(message.contains(part), "{member}: {message}");
    }
}
