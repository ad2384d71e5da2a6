//! PLY files.

use sabi_surface::load::{LoadError, LoadOptions, load_bytes};
use sabi_surface::model::Model;

use crate::builder::nothing;
use crate::faults::said;
use crate::promises;

const VERTICES: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

fn read(text: &str) -> Result<Model, LoadError> {
    let model = load_bytes("thing.ply", text.as_bytes(), &mut nothing, &LoadOptions::default())?;
    promises::check(&model);
    Ok(model)
}

/// A text file with so many vertices and faces.
fn file(vertex: &str, vertices: &[&str], face: &str, faces: &[&str]) -> String {
    format!(
        "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex {}\n{vertex}element face {}\n{face}end_header\n{}\n{}\n",
        vertices.len(),
        faces.len(),
        vertices.join("\n"),
        faces.join("\n")
    )
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const CORNERS: &str = "property list uchar int vertex_indices\n";
const SQUARE: [&str; 4] = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"];

/// The square with normals, colors and texture coordinates, in a binary format.
fn binary(is_big: bool) -> Vec<u8> {
    let name = if is_big {
        "binary_big_endian"
    } else {
        "binary_little_endian"
    };
    let mut file = format!(
        "ply\r\nformat {name} 1.0\r\nelement vertex 4\r\nproperty double x\r\nproperty float y\r\nproperty float z\r\n\
         property float s\r\nproperty float t\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\n\
         property ushort alpha\r\nelement face 1\r\nproperty list uint8 uint16 vertex_index\r\nend_header\r\n"
    )
    .into_bytes();
    let mut put = |bytes: &[u8]| {
        if is_big {
            file.extend(bytes.iter().rev());
        } else {
            file.extend(bytes);
        }
    };
    for [x, y, z] in VERTICES {
        put(&f64::from(x).to_le_bytes());
        for number in [y, z, x, y] {
            put(&number.to_le_bytes());
        }
        [255u8, 128, 0].iter().for_each(|byte| put(&[*byte]));
        put(&0x8000u16.to_le_bytes());
    }
    put(&[4]);
    (0..4u16).for_each(|corner| put(&corner.to_le_bytes()));
    file
}

#[test]
fn all_three_formats_give_the_same_model() {
    let vertex = format!(
        "{XYZ}property float s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty ushort alpha\n"
    );
    let vertices = VERTICES.map(|[x, y, z]| format!("{x} {y} {z} {x} {y} 255 128 0 32768"));
    let text = file(
        &vertex,
        &vertices.each_ref().map(String::as_str),
        CORNERS,
        &["4 0 1 2 3"],
    );
    let model = read(&text).unwrap();
    assert_eq!(model.mesh.positions, VERTICES);
    assert_eq!(model.mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(model.mesh.uvs[..2], [[0.0, 1.0], [1.0, 1.0]]);
    let [r, g, b, a] = model.mesh.colors[0];
    assert_eq!([r, b], [1.0, 0.0]);
    assert!(
        (g - 0.215_86).abs() < 1e-5 && (a - 0.5).abs() < 1e-4,
        "integers are sRGB, but for alpha: {g} {a}"
    );
    assert_eq!(
        (model.stem.as_str(), &model.parts[..]),
        ("thing", &["thing".to_string()][..])
    );
    for (name, is_big) in [("thing.ply", false), ("thing.ply", true), ("thing.obj", true)] {
        let other = load_bytes(name, &binary(is_big), &mut nothing, &LoadOptions::default()).unwrap();
        assert_eq!(other.mesh, model.mesh, "{name} {is_big}");
    }
    assert_eq!(read(&text.replace('\n', "\r\n")).unwrap().mesh, model.mesh);
}

#[test]
fn colors_of_floats_are_linear() {
    let vertex = format!("{XYZ}property float red\nproperty float green\nproperty float blue\n");
    let vertices = ["0 0 0 1 0.5 0.25", "1 0 0 1 0.5 0.25", "0 1 0 1 0.5 0.25"];
    let model = read(&file(&vertex, &vertices, CORNERS, &["3 0 1 2"])).unwrap();
    assert_eq!(model.mesh.colors, [[1.0, 0.5, 0.25, 1.0]; 3]);
}

#[test]
fn missing_normals_are_smooth_and_those_of_the_file_are_kept() {
    let bent = ["-1 0 0", "0 0 0", "0 1 0", "-1 1 0", "1 0 -0.5", "1 1 -0.5"];
    let faces = ["4 0 1 2 3", "4 1 4 5 2"];
    let made = read(&file(XYZ, &bent, CORNERS, &faces)).unwrap();
    assert_eq!(made.mesh.positions.len(), 6, "the fold is shaded smoothly");
    let vertex = format!("{XYZ}property float nx\nproperty float ny\nproperty float nz\n");
    let with_normals: Vec<String> = bent.iter().map(|at| format!("{at} 0 0 2")).collect();
    let with_normals: Vec<&str> = with_normals.iter().map(String::as_str).collect();
    let own = read(&file(&vertex, &with_normals, CORNERS, &faces)).unwrap();
    assert_eq!(own.mesh.normals, [[0.0, 0.0, 1.0]; 6]);
}

#[test]
fn faces_may_have_texture_coordinates_and_pictures_of_their_own() {
    let face = format!("{CORNERS}property list uchar float texcoord\nproperty int texnumber\n");
    let faces = ["3 0 1 2 6 0 0 1 0 1 1 1", "3 0 2 3 6 0 0 0.5 0.5 0 1 0", "3 1 2 3 0 -1"];
    let text = file(XYZ, &SQUARE, &face, &faces);
    let text = text.replace(
        "comment made by hand",
        "comment TextureFile one.png\ncomment TextureFile my two.png",
    );
    let mut beside = |path: &str| match path {
        "my two.png" => Ok(vec![2]),
        _ => Err("there is no such file".to_string()),
    };
    let model = load_bytes("thing.ply", text.as_bytes(), &mut beside, &LoadOptions::default()).unwrap();
    promises::check(&model);
    let names: Vec<&str> = model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["one", "my two", ""]);
    assert_eq!(model.mesh.triangle_material, [1, 0, 2]);
    let uv = |triangle: usize, corner: usize| model.mesh.uvs[model.mesh.triangles[triangle][corner] as usize];
    assert_eq!([uv(0, 2), uv(1, 1), uv(1, 2)], [[1.0, 0.0], [0.5, 0.5], [0.0, 0.0]]);
    assert_eq!(
        model.warnings,
        [
            "Some faces have no texture coordinates; theirs are zero.",
            "The picture one.png cannot be read: there is no such file.",
        ]
    );
}

#[test]
fn a_lone_picture_colors_the_unnamed_material() {
    let vertex = format!("{XYZ}property float u\nproperty float v\n");
    let text = file(&vertex, &["0 0 0 0 0", "1 0 0 1 0", "0 1 0 0 1"], CORNERS, &["3 0 1 2"]);
    let text = text.replace("comment made by hand", "comment TextureFile skin.png");
    let mut beside = |_: &str| Ok(vec![1]);
    let model = load_bytes("thing.ply", text.as_bytes(), &mut beside, &LoadOptions::default()).unwrap();
    assert_eq!((model.materials.len(), model.materials[0].name.as_str()), (1, ""));
    assert!(model.materials[0].base_color.is_some());
    assert_eq!(model.images[0].name, "skin.png");
}

#[test]
fn other_elements_are_passed_over() {
    let text = file(XYZ, &SQUARE[..3], CORNERS, &["3 0 1 2"]);
    let text = text
        .replace(
            "end_header\n",
            "element edge 2\nproperty int a\nproperty list uchar float b\nend_header\n",
        )
        .replace(
            "element vertex",
            "element camera 1\nproperty float view\nelement vertex",
        )
        .replace("end_header\n", "end_header\n7\n");
    let model = read(&format!("{text}1 2 0.5 0.5\n2 0\n")).unwrap();
    assert_eq!(model.mesh.triangles.len(), 1);
}

/// Edits of a good file, as a text and its replacement, and what is said then.
const FAULTS: &[(&str, &str, &str)] = &[
    (
        "4 0 1 2 3",
        "4 0 1 2 4",
        "the file is damaged: face 0 names vertex 4 of 4",
    ),
    (
        "4 0 1 2 3",
        "4 0 1 2 -1",
        "the file is damaged: face 0 names vertex -1 of 4",
    ),
    (
        "4 0 1 2 3",
        "4 0 1 2",
        "the file is damaged: it ends in the middle of its elements; it was cut off",
    ),
    ("1 1 0", "1 one 0", "the file is damaged: `one` is not a number"),
    (
        "element vertex 4",
        "element vertex 4000000000",
        "the file is damaged: it promises 4000000000 elements `vertex` and is too short for them; it was cut off",
    ),
    (
        "4 0 1 2 3",
        "4000000000 0 1 2 3",
        "the file is damaged: a list of it promises 4000000000 entries; it was cut off",
    ),
    (
        "element vertex 4",
        "element vertex many",
        "the file is damaged: `many` is not a number of elements",
    ),
    ("ascii", "runes", "the file is damaged: its format `runes` is unknown"),
    (
        "format ascii 1.0\n",
        "",
        "the file is damaged: its header does not say its format",
    ),
    ("end_header", "end", "the file is damaged: its header has no end"),
    (
        "float y",
        "float w",
        "the file is damaged: its vertices have no `x`, `y` and `z`",
    ),
    (
        "float y",
        "half y",
        "the file is damaged: `half` is no type of a property",
    ),
    (
        "vertex_indices",
        "indices",
        "the file is damaged: its faces have no `vertex_indices`",
    ),
    (
        "element face 1\nproperty list uchar int vertex_indices\n",
        "",
        "it has no triangles; it is a cloud of points without faces; make a mesh of them first",
    ),
];

#[test]
fn each_fault_has_its_sentence() {
    let square = file(XYZ, &SQUARE, CORNERS, &["4 0 1 2 3"]);
    for (text, other, sentence) in FAULTS {
        let text = square.replace(text, other);
        assert_eq!(said("thing.ply", text.as_bytes()), format!("thing.ply: {sentence}"));
    }
}

#[test]
fn counts_without_properties_and_further_uv_sets_are_refused() {
    // No loop runs as often as a header says where elements have no properties.
    let endless = "ply\nformat binary_little_endian 1.0\nelement nothing 4000000000000\nend_header\n";
    assert_eq!(said("thing.ply", endless.as_bytes()), "thing.ply: it has no triangles");
    let options = LoadOptions {
        uv_set: 1,
        ..LoadOptions::default()
    };
    let error = load_bytes("thing.ply", &binary(false), &mut nothing, &options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "thing.ply: it has no UV set 1; PLY files have set 0 alone"
    );
}

#[test]
fn strips_of_triangles_are_read_with_their_ends() {
    let strips = |rows: &[&str]| {
        let face = "property list int int vertex_indices\n";
        let corners = ["0 0 0", "1 0 0", "0 1 0", "1 1 0"];
        read(&file(XYZ, &corners, face, rows).replace("element face", "element tristrips")).unwrap()
    };
    for rows in [
        &["4 0 1 2 3"][..],
        &["8 0 1 2 -1 1 3 2 -1"],
        &["3 0 1 2", "3 1 3 2"],
        &["7 0 1 2 2 1 1 3"],
    ] {
        let mesh = strips(rows).mesh;
        let normals = mesh.normals.iter().all(|normal| *normal == [0.0, 0.0, 1.0]);
        assert!(normals, "{rows:?}: {:?}", mesh.normals);
        let expected = if rows == ["7 0 1 2 2 1 1 3"] { 1 } else { 2 };
        assert_eq!(mesh.triangles.len(), expected, "{rows:?}");
    }
}

#[test]
fn colors_of_faces_are_read_where_vertices_have_none() {
    let face = format!("{CORNERS}property uchar red\nproperty uchar green\nproperty uchar blue\n");
    let faces = ["3 0 1 2 255 0 0", "3 0 2 3 0 0 255"];
    let mesh = read(&file(XYZ, &SQUARE, &face, &faces)).unwrap().mesh;
    let colors = |triangle: usize| mesh.triangles[triangle].map(|vertex| mesh.colors[vertex as usize]);
    assert_eq!(colors(0), [[1.0, 0.0, 0.0, 1.0]; 3]);
    assert_eq!(colors(1), [[0.0, 0.0, 1.0, 1.0]; 3]);
}

/// A triangle whose vertices have one color of a type.
fn colored(kind: &str, color: &str) -> Model {
    let vertex = format!("{XYZ}property {kind} red\nproperty {kind} green\nproperty {kind} blue\n");
    let vertices = SQUARE[..3].iter().map(|at| format!("{at} {color}"));
    let vertices: Vec<String> = vertices.collect();
    let vertices: Vec<&str> = vertices.iter().map(String::as_str).collect();
    read(&file(&vertex, &vertices, CORNERS, &["3 0 1 2"])).unwrap()
}

#[test]
fn codes_of_bytes_are_colors_in_any_type() {
    let above = ["The colors of vertices reach above 1; they are taken as codes of 0 to 255."];
    let small = |code: u32| {
        format!(
            "No color of the vertices is above {code}, though its type has larger numbers; they are taken as codes of 0 to {code}."
        )
    };
    let (bytes, words) = ([small(255)], [small(65535)]);
    let above = above.map(str::to_owned);
    for (kind, color, warnings) in [
        ("uchar", "255 128 0", &[][..]),
        ("float", "255 128 0", &above[..]),
        ("double", "255 128 0", &above[..]),
        ("char", "255 128 0", &[]),
        ("short", "255 128 0", &bytes),
        ("ushort", "255 128 0", &bytes),
        ("int", "255 128 0", &bytes),
        ("uint", "255 128 0", &bytes),
        ("ushort", "65535 32896 0", &[]),
        ("int", "65535 32896 0", &words),
        ("int", "2147483647 1077952576 0", &[]),
        ("uint", "4294967295 2155905152 0", &[]),
    ] {
        let model = colored(kind, color);
        // 128 of 255 is 0.2158605 in linear light (IEC 61966-2-1).
        let [r, g, b, a] = model.mesh.colors[0];
        assert_eq!([r, b, a], [1.0, 0.0, 1.0], "{kind} {color}");
        assert!((g - 0.215_860_5).abs() < 1e-3, "{kind} {color}: {g}");
        assert_eq!(model.warnings, warnings, "{kind} {color}");
    }
    // Somewhat overbright light stays light, and black needs no guess.
    assert_eq!(colored("float", "1.5 0.5 0").mesh.colors[0], [1.5, 0.5, 0.0, 1.0]);
    assert!(colored("int", "0 0 0").warnings.is_empty());
}

#[test]
fn alpha_goes_as_far_as_the_colors_of_its_type() {
    let vertices = ["0 0 0", "1 0 0", "0 1 0"];
    for (kind, of_alpha, color, alpha) in [
        ("ushort", "ushort", "200 100 0 65535", 1.0),
        ("ushort", "ushort", "255 100 0 51", 0.2),
        ("float", "float", "255 128 0 0.25", 0.25),
        ("float", "float", "1 0.5 0 51", 0.2),
        ("uchar", "float", "255 128 0 0.25", 0.25),
    ] {
        let vertex = format!(
            "{XYZ}property {kind} red\nproperty {kind} green\nproperty {kind} blue\nproperty {of_alpha} alpha\n"
        );
        let vertices = vertices.map(|at| format!("{at} {color}"));
        let text = file(&vertex, &vertices.each_ref().map(String::as_str), CORNERS, &["3 0 1 2"]);
        let [.., is] = read(&text).unwrap().mesh.colors[0];
        assert!((is - alpha).abs() < 1e-6, "{kind} {color}: {is}");
    }
}

#[test]
fn materials_that_are_lists_of_numbers_are_told() {
    let face = format!("{CORNERS}property int material_index\n");
    let told = ["The materials of the file (`material`, `material_index`) are left out."];
    let indexed = file(XYZ, &SQUARE[..3], &face, &["3 0 1 2 0"]);
    assert_eq!(read(&indexed).unwrap().warnings, told);
    let listed = indexed.replace(
        "end_header\n",
        "element material 1\nproperty uchar ambient_red\nend_header\n",
    );
    assert_eq!(read(&format!("{listed}255\n")).unwrap().warnings, told);
}

#[test]
fn elements_may_begin_with_the_code_of_a_line_feed() {
    // The lowest byte of the first x is 0A.
    let first = f32::from_bits(0x3f80_000a);
    for end in ["\n", "\r", "\r\n"] {
        let header = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex 3\n{XYZ}element face 1\n{CORNERS}end_header\n"
        );
        let mut bytes = header.replace('\n', end).into_bytes();
        for number in [first, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 3.0, 0.0] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.push(3);
        (0..3u32).for_each(|corner| bytes.extend(corner.to_le_bytes()));
        let model = load_bytes("thing.ply", &bytes, &mut nothing, &LoadOptions::default()).unwrap();
        assert_eq!(model.mesh.positions[0], [first, 0.0, 0.0], "{end:?}");
    }
}
