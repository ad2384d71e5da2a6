//! Geometry without area is never visible, so it is ignored.

use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::Model;
use serde_json::json;

use crate::builder::{Gltf, nothing};
use crate::fbx_builder::Fbx;
use crate::promises;

fn read(name: &str, text: &str) -> Model {
    let model = load_bytes(name, text.as_bytes(), &mut nothing, &LoadOptions::default()).unwrap();
    promises::check(&model);
    model
}

/// Lowest and highest coordinates.
fn bounds(model: &Model) -> [[f32; 3]; 2] {
    let fold = |pick: fn(f32, f32) -> f32| {
        let positions = model.mesh.positions.iter().copied();
        positions
            .reduce(|a, b| [0, 1, 2].map(|axis| pick(a[axis], b[axis])))
            .unwrap()
    };
    [fold(f32::min), fold(f32::max)]
}

const UNIT: [[f32; 3]; 2] = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]];

/// Collada document of a triangle in the node `leaf`, and of one in a node `ghost` that is scaled to nothing.
fn dae() -> String {
    let triangle = r##"<geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
        <technique_common><accessor source="#a" count="3" stride="3"/></technique_common></source>
        <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
        <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>"##;
    let node =
        |name: &str, place: &str| format!(r##"<node name="{name}">{place}<instance_geometry url="#g"/></node>"##);
    let ghost = node("ghost", "<translate>100 0 0</translate><scale>0 0 0</scale>");
    format!(
        r##"<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><up_axis>Y_UP</up_axis></asset>
        <library_geometries>{triangle}</library_geometries>
        <library_visual_scenes><visual_scene id="s">{}{ghost}</visual_scene></library_visual_scenes>
        <scene><instance_visual_scene url="#s"/></scene></COLLADA>"##,
        node("leaf", "")
    )
}

#[test]
fn geometry_without_area_does_not_affect_bounds() {
    let mut scaled = Gltf::triangle();
    scaled.push(
        "nodes",
        json!({ "name": "ghost", "mesh": 0, "scale": [0, 0, 0], "translation": [100, 0, 0] }),
    );
    let model = scaled.model();
    let ghost = "What has no area, such as a part that is scaled to nothing, is left out: `ghost`.";
    assert_eq!((bounds(&model), model.parts.len()), (UNIT, 1));
    assert_eq!(model.warnings, [ghost]);
    assert_eq!(model.origins.unwrap().placed.len(), 1);

    let leaf = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 100 0 0\nv 50 0 0\no leaf\nf 1 2 3\n";
    let obj = read("a.obj", &format!("{leaf}o ghost\nf 4 4 4\nf 1 4 5\n"));
    assert_eq!((bounds(&obj), &obj.warnings[..]), (UNIT, &[ghost.to_owned()][..]));
    let one = read("a.obj", &format!("{leaf}f 1 4 5\nf 2 4 4\n"));
    let told = "2 triangles without an area, away from the surface, had to be left out.";
    assert_eq!((bounds(&one), &one.warnings[..]), (UNIT, &[told.to_owned()][..]));

    let facet = |corners: &str| {
        let corners = corners.split(',').map(|at| format!("vertex {at}\n"));
        format!(
            "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n",
            corners.collect::<String>()
        )
    };
    let (leaf, ghost_facet) = (facet("0 0 0,1 0 0,0 1 0"), facet("9 9 9,8 8 8,9 9 9"));
    let stl = read(
        "a.stl",
        &format!("solid leaf\n{leaf}endsolid leaf\nsolid ghost\n{ghost_facet}endsolid ghost\n"),
    );
    assert_eq!((bounds(&stl), &stl.warnings[..]), (UNIT, &[ghost.to_owned()][..]));

    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n\
               property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n-7 -7 0\n3 0 1 2\n3 3 3 3\n";
    assert_eq!(bounds(&read("a.ply", ply)), UNIT);
    let dae = read("a.dae", &dae());
    assert_eq!((bounds(&dae), &dae.warnings[..]), (UNIT, &[ghost.to_owned()][..]));

    let mut fbx = Fbx::square();
    let entries: [(&str, &str, &[f64]); 2] = [
        ("Lcl Translation", "Lcl Translation", &[0.0, 0.0, 300.0]),
        ("Lcl Scaling", "Lcl Scaling", &[0.0, 0.0, 0.0]),
    ];
    fbx.place(3, "ghost", &entries);
    fbx.connect(1, 3, None);
    let fbx = fbx.model();
    assert_eq!((bounds(&fbx), &fbx.warnings[..]), (UNIT, &[ghost.to_owned()][..]));
}

#[test]
fn a_far_model_is_recentered_in_spite_of_empty_geometry_at_the_origin() {
    let mut file = Gltf::triangle();
    file.json["nodes"][0]["translation"] = json!([4_000_000, 0, 0]);
    file.push("nodes", json!({ "name": "ghost", "mesh": 0, "scale": [0, 0, 0] }));
    let model = file.model();
    assert_eq!(model.middle, [4_000_000.5, 0.5, 0.0]);
    assert_eq!(bounds(&model), [[-0.5, -0.5, 0.0], [0.5, 0.5, 0.0]]);
}

#[test]
fn lines_that_close_the_surface_are_kept() {
    // A square whose left half has a corner more on the common edge, and a line that closes the slit.
    let slit = "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 1 1 0\nv 2 0 0\nv 2 2 0\n\
                f 1 2 5\nf 1 5 4\nf 4 5 3\nf 2 6 7\nf 2 7 3\nf 2 3 5\n";
    let model = read("a.obj", slit);
    assert_eq!((model.mesh.triangles.len(), model.warnings.len()), (6, 0));
}
