use std::path::PathBuf;

use sabi_graph::PortType;

use crate::formula::Formula;
use crate::kind::{Argument, Denoise, InputDefault, Kind, Reads, Shape};
use crate::{Libraries, Library, SourceFile, read_kind};

const SURFACE: &str = "fn here(source: texture_2d_array<f32>, at: Surface) -> vec4f { return textureLoad(source, at.texel.xy, at.texel.z, 0); }";

fn read(text: &str) -> Result<Kind, String> {
    let core = Library::builtin_files().1.text("core").unwrap().to_owned();
    let libraries = Libraries([("core".to_owned(), core), ("surface".to_owned(), SURFACE.to_owned())].into());
    let file = SourceFile {
        path: PathBuf::from("test/node.wgsl"),
        id: "test/node".to_owned(),
        text: format!("//! Test\n//! A test.\n//! @use surface\n\n{text}"),
    };
    read_kind(&file, &libraries).map_err(|faults| faults[0].message.clone())
}

#[test]
fn the_header_is_read() {
    let file = SourceFile {
        path: PathBuf::from("test/node.wgsl"),
        id: "test/node".to_owned(),
        text: "//! Clouds\n//! Soft clouds.\n//!\n//! More of it,\n//!   * indented.\n//! @alias fbm perlin\n//! @version 3 @was old/one old/two\n//! @alias fog\n\n/// The mask.\nfn mask(at: Surface) -> f32 { return at.position.x; }\n".to_owned(),
    };
    let kind = read_kind(&file, &Library::builtin_files().1).unwrap();
    assert_eq!((kind.label.as_str(), kind.summary.as_str()), ("Clouds", "Soft clouds."));
    assert_eq!(kind.description, "More of it,\n  * indented.");
    assert_eq!(kind.aliases, ["fbm", "perlin", "fog"]);
    assert_eq!(
        (kind.version, kind.formerly),
        (3, vec!["old/one".to_owned(), "old/two".to_owned()])
    );
    assert_eq!(
        (kind.shape, kind.params_size, kind.libraries.len()),
        (Shape::Point, 0, 0)
    );
}

#[test]
fn the_types_of_functions_and_arguments_give_the_port_types() {
    let kind = read(
        "/// Mask.\n/// @input a One. @input b Two. @input c Three. @vector @input d Four.\n\
         fn mask(a: f32, b: vec3f, c: vec3f, d: Material) -> f32 { return a + b.x + c.x + d.alpha; }\n\
         /// Color.\nfn color(b: vec3f) -> vec3f { return b; }\n\
         /// Way.\n/// @vector\nfn way(c: vec3f) -> vec3f { return c; }\n\
         /// Material.\nfn material(d: Material) -> Material { return d; }\n\
         fn helper() -> f32 { return 1.0; }\n",
    )
    .unwrap();
    use PortType::{Color, Mask, Material, Vector};
    assert_eq!(
        kind.inputs.iter().map(|input| input.ty).collect::<Vec<_>>(),
        [Mask, Color, Vector, Material]
    );
    assert_eq!(
        kind.outputs.iter().map(|output| output.ty).collect::<Vec<_>>(),
        [Mask, Color, Vector, Material]
    );
    assert_eq!(kind.outputs[1].arguments, [Argument::Input(1)]);
    assert_eq!(kind.shape, Shape::Point);
}

#[test]
fn inputs_have_neutral_defaults_unless_an_annotation_gives_one() {
    let kind = read(
        "/// Mask.\n/// @input a One. @input b Two. @input c Three.\n/// @vector @input d Four.\n\
         /// @input e Five, which is\n/// long. @optional @default 0.25 @label High five\n\
         /// @input f Six. @default #ffffff @input g Seven. @vector @default 0 1 0\n\
         /// @input h Eight. @type vector @default at.position\n/// @input i Nine. @default at.tangent.xyz @vector\n/// @input j Ten. @default at.texel_size\n\
         fn mask(at: Surface, a: f32, b: vec3f, c: vec3f, d: Material, e: f32, f: vec3f, g: vec3f, h: vec3f, i: vec3f, j: f32) -> f32 {\n\
         return a + b.x + c.x + d.alpha + e + f.x + g.x + h.x + i.x + j; }\n",
    )
    .unwrap();
    let defaults: Vec<InputDefault> = kind.inputs.iter().map(|input| input.default.clone()).collect();
    let knob = |values: &[f32]| InputDefault::Knob(values.to_vec());
    let expression = |text: &str| InputDefault::Expression(text.to_owned());
    assert_eq!(
        defaults,
        [
            knob(&[1.0]),
            knob(&[0.0; 3]),
            knob(&[0.0; 3]),
            InputDefault::PlainMaterial,
            knob(&[0.25]),
            knob(&[1.0; 3]),
            knob(&[0.0, 1.0, 0.0]),
            expression("at.position"),
            expression("at.tangent.xyz"),
            expression("at.texel_size"),
        ]
    );
    assert_eq!(
        (kind.inputs[4].label.as_str(), kind.inputs[4].doc.as_str()),
        ("High five", "Five, which is long.")
    );
    assert_eq!(kind.outputs[0].doc, "Mask.");
}

#[test]
fn a_texture_argument_is_a_field_with_the_type_of_the_result() {
    let kind = read(
        "/// Color.\n/// @input source What. @input by How. @type vector\n\
         fn color(at: Surface, source: texture_2d_array<f32>, by: texture_2d_array<f32>) -> vec3f { return here(source, at).xyz + here(by, at).xyz; }\n",
    )
    .unwrap();
    assert_eq!(kind.shape, Shape::Field);
    let found: Vec<_> = kind
        .inputs
        .iter()
        .map(|input| (input.ty, input.reads, input.default.clone()))
        .collect();
    assert_eq!(
        found,
        [
            (PortType::Color, Reads::Field, InputDefault::Required),
            (PortType::Vector, Reads::Field, InputDefault::Required)
        ]
    );
    assert_eq!(
        kind.outputs[0].arguments,
        [Argument::At, Argument::Input(0), Argument::Input(1)]
    );
}

#[test]
fn later_functions_read_passes_by_name() {
    let kind = read(
        "struct Params {\n/// How often.\n/// @range 1 8 @default 2\nsteps: u32,\n}\n\
         /// Mask.\nfn mask(at: Surface, wide: texture_2d_array<f32>, narrow: texture_2d_array<f32>) -> f32 { return here(wide, at).x + here(narrow, at).x; }\n\
         /// Wide.\n/// @pass 2 @repeat params.steps\nfn wide(at: Surface, narrow: texture_2d_array<f32>) -> f32 { return here(narrow, at).x; }\n\
         /// Narrow.\n/// @pass 1\n/// @input source What. @type color @repeat 3\nfn narrow(at: Surface, source: texture_2d_array<f32>, params: Params) -> f32 { return here(source, at).x; }\n",
    );
    // The first texture of a repeated function must have the type of its result.
    assert!(kind.unwrap_err().contains("holds a color"));
    let kind = read(
        "struct Params {\n/// How often.\n/// @range 1 8 @default 2\nsteps: u32,\n}\n\
         /// Mask.\nfn mask(at: Surface, wide: texture_2d_array<f32>, narrow: texture_2d_array<f32>) -> f32 { return here(wide, at).x + here(narrow, at).x; }\n\
         /// Wide.\n/// @pass 2 @repeat params.steps\nfn wide(at: Surface, narrow: texture_2d_array<f32>) -> f32 { return here(narrow, at).x; }\n\
         /// Narrow.\n/// @pass 1\n/// @input source What.\n/// @repeat 3\nfn narrow(at: Surface, source: texture_2d_array<f32>, params: Params) -> f32 { return here(source, at).x; }\n",
    )
    .unwrap();
    let names: Vec<_> = kind
        .passes
        .iter()
        .map(|pass| (pass.number, pass.function.name.as_str()))
        .collect();
    assert_eq!(names, [(1, "narrow"), (2, "wide")]);
    assert_eq!(kind.passes[0].function.repeat, Some(Formula::Number(3.0)));
    assert_eq!(kind.passes[1].function.repeat, Some(Formula::Param(0)));
    assert_eq!(
        kind.outputs[0].arguments,
        [Argument::At, Argument::Pass(1), Argument::Pass(0)]
    );
    assert_eq!(kind.inputs.len(), 1);
}

#[test]
fn annotations_and_arguments_that_contradict_each_other_are_refused() {
    let mask = |docs: &str, sig: &str, body: &str| {
        read(&format!(
            "/// Mask.\n{docs}\nfn mask({sig}) -> f32 {{ return {body}; }}\n"
        ))
    };
    for (docs, sig, body, part) in [
        ("/// @vector", "a: f32", "a", "needs a function that returns `vec3f`"),
        ("/// @input a One. @input a Two.", "a: f32", "a", "described twice"),
        ("/// @input a", "a: f32", "a", "not described"),
        ("/// @input", "a: f32", "a", "names no argument"),
        ("/// @default 1", "a: f32", "a", "does not belong"),
        ("/// @pass 0", "at: Surface", "at.uv.x", "`@pass` takes"),
        ("/// @pass 1 @pass 2", "at: Surface", "at.uv.x", "twice"),
        ("/// @repeat 0", "at: Surface", "at.uv.x", "`@repeat` takes"),
        ("/// @repeat params.steps", "at: Surface", "at.uv.x", "does not exist"),
        ("/// @input a One. @type color", "a: f32", "a", "is a mask by its type"),
        ("/// @input a One. @type thing", "a: f32", "a", "takes a port type"),
        ("/// @input a One. @optional yes", "a: f32", "a", "nothing behind"),
        ("/// @input a One. @default", "a: f32", "a", "takes a value"),
        ("/// @input a One. @default 1 @default 2", "a: f32", "a", "twice"),
        (
            "/// @input a One. @default at.uv",
            "a: f32, at: Surface",
            "a",
            "not a f32",
        ),
        (
            "/// @input a One. @default at.uv.x.x",
            "a: f32, at: Surface",
            "a",
            "not a f32",
        ),
        (
            "/// @input a One. @default at.position.w",
            "a: f32, at: Surface",
            "a",
            "not a f32",
        ),
        ("/// @input a One. @default 1 2", "a: f32", "a", "one number"),
        (
            "/// @input a One. @default 1",
            "a: Material",
            "a.alpha",
            "no default of its own",
        ),
        ("/// @input A One.", "A: f32", "A", "cannot be the name"),
        ("/// @input a One.", "a: texture_2d<f32>", "1.0", "no port carries"),
        (
            "/// @input a One. @type material",
            "at: Surface, a: texture_2d_array<f32>",
            "here(a, at).x",
            "cannot hold a material",
        ),
    ] {
        let message = mask(docs, sig, body).unwrap_err();
        assert!(message.contains(part), "{docs} {sig}: {message}");
    }
}

#[test]
fn the_initial_value_of_a_wire_must_be_accepted_by_the_parameter() {
    for starts in ["@starts height 1", "@starts gain"] {
        let source = format!("/// Mask.\n/// @input a One. {starts}\nfn mask(a: f32) -> f32 {{ return a; }}\n");
        let message = read(&source).unwrap_err();
        assert!(message.contains("`@starts` takes a parameter"), "{starts}: {message}");
    }
}

#[test]
fn an_input_has_one_type_in_all_functions() {
    let message = read(
        "/// Mask.\n/// @input a One.\nfn mask(a: f32) -> f32 { return a; }\n/// More.\nfn more(a: vec3f) -> vec3f { return a; }\n",
    );
    assert!(message.unwrap_err().contains("another type"));
}

#[test]
fn a_node_of_passes_alone_has_no_output() {
    let message = read("/// First.\n/// @pass 1\nfn first(at: Surface) -> f32 { return at.uv.x; }\n");
    assert!(message.unwrap_err().contains("no output"));
}

#[test]
fn outputs_receive_the_result_of_a_shared_function_by_its_name() {
    let kind = read(
        "struct Found { near: f32, id: f32 }\n\
         /// What is near.\n/// @shared\n/// @input position Where. @vector @optional @default at.position\n\
         fn found(position: vec3f) -> Found { return Found(position.x, position.y); }\n\
         /// Mask.\n/// @input density How much.\nfn mask(found: Found, density: f32) -> f32 { return found.near * density; }\n\
         /// Id.\nfn id(found: Found) -> f32 { return found.id; }\n",
    )
    .unwrap();
    let names: Vec<&str> = kind.outputs.iter().map(|output| output.name.as_str()).collect();
    assert_eq!((names, kind.shape), (vec!["mask", "id"], Shape::Point));
    assert_eq!(
        (kind.shared[0].name.as_str(), &kind.shared[0].arguments[..]),
        ("found", &[Argument::Input(0)][..])
    );
    assert_eq!(kind.outputs[0].arguments, [Argument::Shared(0), Argument::Input(1)]);
    assert_eq!(kind.outputs[1].arguments, [Argument::Shared(0)]);
}

#[test]
fn only_a_mean_over_rays_can_be_denoised() {
    let node = |rays: &str, pass: &str| {
        read(&format!(
            "struct Params {{\n    /// Rays.\n    /// @range 1 64 @default 4\n    rays: u32,\n}}\n\
             struct Ray {{ origin: vec3f, reach: f32, direction: vec3f }}\n\
             struct Hit {{ is_hit: bool, distance: f32, triangle: u32 }}\n{rays}{pass}"
        ))
    };
    let rays = "/// Rays.\n/// @rays params.rays\n\
                fn ray(at: Surface, index: u32, params: Params) -> Ray { return Ray(at.position, f32(index), at.normal); }\n";
    let found = "/// Found.\n/// @pass 1 @denoise shading\nfn found(hit: Hit) -> f32 { return hit.distance; }\n\
                 /// Plain.\n/// @pass 2\nfn plain(hit: Hit) -> f32 { return hit.distance; }\n\
                 /// Mask.\nfn mask(found: f32, plain: f32) -> f32 { return found + plain; }\n";
    let kind = node(rays, found).unwrap();
    let denoised: Vec<_> = kind.passes.iter().map(|pass| pass.denoise).collect();
    assert_eq!(denoised, [Some(Denoise::Shading), None]);
    let both = found.replace("@pass 2", "@pass 2 @denoise triangles");
    let refused = node(rays, &both).unwrap_err();
    assert_eq!(refused, "`plain` is denoised in another way than the passes before it.");
    let refused = node(rays, &found.replace("shading", "all")).unwrap_err();
    assert_eq!(refused, "`@denoise` takes `triangles` or `shading`.");
    for text in [
        "/// Mask.\n/// @denoise shading\nfn mask(hit: Hit) -> f32 { return hit.distance; }\n",
        "/// Ray.\n/// @rays params.rays @denoise shading\n\
         fn ray(at: Surface, index: u32, params: Params) -> Ray { return Ray(at.position, f32(index), at.normal); }\n\
         /// Mask.\nfn mask(hit: Hit) -> f32 { return hit.distance; }\n",
    ] {
        let refused = node(if text.contains("@rays") { "" } else { rays }, text).unwrap_err();
        assert!(
            refused.ends_with("is no mean over rays, and has no grain."),
            "{refused}"
        );
    }
    let refused =
        read("/// Mask.\n/// @denoise shading\nfn mask(at: Surface) -> f32 { return at.position.x; }\n").unwrap_err();
    assert_eq!(refused, "`mask` is no mean over rays, and has no grain.");
}
