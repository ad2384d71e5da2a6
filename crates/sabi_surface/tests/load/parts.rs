//! Parts that count: chosen by their names, or told by what these mean to engines.

use sabi_surface::load::{LoadOptions, PartChoice, load_bytes};
use sabi_surface::model::{ExclusionReason, FilePart, Model};
use serde_json::json;

use crate::builder::{Gltf, nothing};
use crate::fbx_builder::Fbx;
use crate::promises;

fn choosing(parts: &[&str], without: &[&str]) -> LoadOptions {
    let list = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    LoadOptions {
        parts: PartChoice {
            parts: list(parts),
            without: list(without),
        },
        ..LoadOptions::default()
    }
}

/// A rock of two levels, in the middle of a hull and of moss; each with a material of its name.
fn rock() -> Gltf {
    let mut file = Gltf::new();
    for name in ["Rock_LOD0", "Rock_LOD1", "UCX_Rock", "Moss"] {
        let size = if name == "UCX_Rock" { 1000.0 } else { 1.0 };
        let positions = file.floats("VEC3", &[0.0, 0.0, 0.0, size, 0.0, 0.0, 0.0, size, 0.0]);
        let material = file.push("materials", json!({ "name": name }));
        file.place(
            name,
            json!({ "attributes": { "POSITION": positions }, "material": material }),
        );
    }
    file
}

fn left_out(model: &Model) -> Vec<(&str, ExclusionReason)> {
    let parts = model.file_parts.iter();
    let out = parts.filter_map(|FilePart { name, left_out, .. }| Some((name.as_str(), (*left_out)?)));
    out.collect()
}

#[test]
fn hulls_and_coarser_levels_are_no_parts_of_the_model() {
    let model = rock().model();
    assert_eq!(model.parts, ["Rock_LOD0", "Moss"]);
    assert_eq!(
        left_out(&model),
        [
            ("Rock_LOD1", ExclusionReason::CoarserLevel),
            ("UCX_Rock", ExclusionReason::Hull)
        ]
    );
    let materials: Vec<&str> = model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(materials, ["Rock_LOD0", "Moss"]);
    let reach = model.mesh.positions.as_flattened().iter().copied().fold(0.0, f32::max);
    assert_eq!(reach, 1.0, "a hull does not count for bounds");
}

#[test]
fn parts_are_chosen_by_name_in_every_format() {
    let named = |keyword: &str, end: &str, body: &str| -> String {
        let parts = ["Rock_LOD0", "Rock_LOD1", "Moss"].map(|name| format!("{keyword} {name}\n{body}{end}\n"));
        parts.concat()
    };
    let obj = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", named("o", "", "f 1 2 3"));
    let stl = named(
        "solid",
        "endsolid",
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n",
    );
    let files = [
        ("a.glb", rock().glb()),
        ("a.obj", obj.into_bytes()),
        ("a.stl", stl.into_bytes()),
    ];
    for (name, bytes) in files {
        let parts = |options: &LoadOptions| {
            let model = load_bytes(name, &bytes, &mut nothing, options).unwrap();
            promises::check(&model);
            model.parts
        };
        assert_eq!(parts(&choosing(&[], &[])), ["Rock_LOD0", "Moss"], "{name}");
        assert_eq!(parts(&choosing(&["*LOD?"], &[])), ["Rock_LOD0", "Rock_LOD1"], "{name}");
        assert_eq!(
            parts(&choosing(&["Moss", "Rock_LOD1"], &[])),
            ["Rock_LOD1", "Moss"],
            "{name}"
        );
        assert_eq!(parts(&choosing(&[], &["Rock_LOD0"])), ["Moss"], "{name}");
    }
}

#[test]
fn the_nodes_of_fbx_are_parts_by_their_names() {
    let mut file = Fbx::square();
    for (id, name) in [(3, "Board_LOD1"), (4, "UCX_Board")] {
        file.place(id, name, &[]);
        file.connect(1, id, None);
    }
    let parts = |options: &LoadOptions| file.load_with(options).unwrap().parts;
    assert_eq!(parts(&choosing(&[], &[])), ["board"]);
    assert_eq!(parts(&choosing(&["*"], &["UCX_*"])), ["board", "Board_LOD1"]);
}

#[test]
fn a_name_that_no_part_has_is_refused() {
    let refused =
        |parts: &[&str], without: &[&str]| rock().load_with(&choosing(parts, without)).unwrap_err().to_string();
    assert_eq!(
        refused(&["Rok"], &["Mos"]),
        "test.glb: it has no part `Rok` and `Mos`; its parts are `Moss`, `Rock_LOD0`, `Rock_LOD1` and `UCX_Rock`"
    );
    assert_eq!(
        refused(&["Moss"], &["M*"]),
        "test.glb: the choice of its parts leaves none"
    );
    let model = rock().load_with(&choosing(&[], &["Stone*"])).unwrap();
    assert_eq!(model.warnings, ["No part fits `Stone*`, so it leaves none out."]);
}

/// Rocks of two levels and a hull, each mesh below a node of that name, all below one for the whole file.
fn grouped() -> Gltf {
    let mut file = Gltf::new();
    let mut groups = Vec::new();
    for (group, size) in [("LOD0", 1.0), ("LOD1", 1.0), ("collision", 1000.0)] {
        let positions = file.floats("VEC3", &[0.0, 0.0, 0.0, size, 0.0, 0.0, 0.0, size, 0.0]);
        let primitive = json!({ "attributes": { "POSITION": positions } });
        let mesh = file.push("meshes", json!({ "primitives": [primitive] }));
        let rock = file.push("nodes", json!({ "name": "rock", "mesh": mesh }));
        groups.push(file.push("nodes", json!({ "name": group, "children": [rock] })));
    }
    file.push("nodes", json!({ "name": "Scene", "children": groups }));
    file
}

#[test]
fn names_of_nodes_above_parts_say_what_the_parts_are() {
    let model = grouped().model();
    assert_eq!(model.parts, ["rock"]);
    let parts = model.file_parts.iter();
    let of_groups = parts.map(|part| (part.left_out, part.of_group.as_deref()));
    assert_eq!(
        of_groups.collect::<Vec<_>>(),
        [
            (None, None),
            (Some(ExclusionReason::CoarserLevel), Some("LOD1")),
            (Some(ExclusionReason::Hull), Some("collision"))
        ]
    );
    let triangles = |parts: &[&str], without: &[&str]| {
        let model = grouped().load_with(&choosing(parts, without));
        model.map(|model| model.mesh.triangles.len())
    };
    assert_eq!(triangles(&["LOD1"], &[]), Ok(1));
    assert_eq!(triangles(&["*"], &["coll*"]), Ok(2));
    assert_eq!(triangles(&["Scene"], &[]), Ok(3));
    assert!(triangles(&[], &["Cameras"]).is_err());
}

#[test]
fn names_of_nodes_above_parts_count_in_every_format_with_nodes() {
    let mut fbx = Fbx::square();
    for (id, name, above) in [(3, "Board_LOD1", None), (4, "plank", Some(3))] {
        fbx.place(id, name, &[]);
        if let Some(above) = above {
            fbx.connect(id, above, None);
        }
    }
    fbx.connect(1, 4, None);
    let node =
        |name: &str| format!(r##"<node name="{name}"><node name="board"><instance_geometry url="#m"/></node></node>"##);
    let dae = format!(
        r##"<COLLADA><asset/><library_geometries><geometry id="m"><mesh><source id="p"><float_array>0 0 0 1 0 0 0 1 0</float_array>
        <technique_common><accessor stride="3"/></technique_common></source><vertices id="v"><input semantic="POSITION"
        source="#p"/></vertices><triangles><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
        </library_geometries><library_visual_scenes><visual_scene>{}{}</visual_scene></library_visual_scenes></COLLADA>"##,
        node("LOD0"),
        node("LOD1")
    );
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\no LOD0\ng board\nf 1 2 3\no LOD1\ng board\nf 1 2 3\n";
    for (name, bytes) in [
        ("a.fbx", fbx.binary()),
        ("a.dae", dae.into_bytes()),
        ("a.obj", obj.as_bytes().to_vec()),
    ] {
        let left_out = |options: &LoadOptions| {
            let model = load_bytes(name, &bytes, &mut nothing, options).unwrap();
            promises::check(&model);
            let parts = model.file_parts.into_iter().filter(|part| part.left_out.is_some());
            parts.map(|part| part.name).collect::<Vec<String>>()
        };
        let coarse = left_out(&choosing(&[], &[]));
        assert_eq!(coarse, [if name == "a.fbx" { "plank" } else { "board" }], "{name}");
        let level = if name == "a.fbx" { "Board_LOD1" } else { "LOD1" };
        assert_eq!(left_out(&choosing(&["*"], &[level])).len(), 1, "{name}");
    }
}
