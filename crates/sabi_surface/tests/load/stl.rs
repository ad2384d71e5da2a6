//! STL files.

use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::Model;

use crate::builder::nothing;
use crate::faults::said;
use crate::promises;

/// Corners of a tent: two squares of two facets each that meet at a right angle.
fn tent() -> Vec<[[f32; 3]; 3]> {
    let [a, b, c, d, e, f] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, -1.0],
        [0.0, 1.0, -1.0],
    ];
    vec![[a, b, c], [a, c, d], [d, c, e], [d, e, f]]
}

fn binary(header: &str) -> Vec<u8> {
    let mut file = header.as_bytes().to_vec();
    file.resize(80, b' ');
    file.extend((tent().len() as u32).to_le_bytes());
    for facet in tent() {
        file.extend([0; 12]);
        file.extend(facet.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        file.extend([1, 2]);
    }
    file
}

fn text() -> String {
    let facet = |facet: [[f32; 3]; 3]| {
        let corners = facet.map(|[x, y, z]| format!("      vertex {x} {y} {z:e}\n"));
        format!(
            "  facet normal 0 0 1\n    outer loop\n{}    endloop\n  endfacet\n",
            corners.concat()
        )
    };
    let facets: Vec<String> = tent().into_iter().map(facet).collect();
    format!("solid tent\n{}endsolid tent\n", facets.concat())
}

fn read(bytes: &[u8]) -> Model {
    let model = load_bytes("thing.stl", bytes, &mut nothing, &LoadOptions::default()).unwrap();
    promises::check(&model);
    model
}

#[test]
fn text_and_binary_give_the_same_flat_facets() {
    let model = read(&binary("made by hand"));
    assert_eq!(model.mesh.triangles.len(), 4);
    let normal = |triangle: usize| model.mesh.triangles[triangle].map(|vertex| model.mesh.normals[vertex as usize]);
    assert_eq!([normal(1), normal(2)], [[[0.0, 0.0, 1.0]; 3], [[0.0, 1.0, 0.0]; 3]]);
    assert!(
        model.mesh.uvs.is_empty() && model.warnings.is_empty(),
        "{:?}",
        model.warnings
    );
    assert_eq!(model.parts, ["thing"]);
    let other = read(text().as_bytes());
    assert_eq!(
        (&other.mesh, &other.parts[..]),
        (&model.mesh, &["tent".to_string()][..])
    );
    // Programs write this word into binary files, too, and shout it in text files.
    assert_eq!(read(&binary("solid thing")).mesh, model.mesh);
    assert_eq!(read(text().to_uppercase().as_bytes()).mesh, model.mesh);
    assert_eq!(
        read(text().replace('\n', " ").replace("tent", "\n").as_bytes()).mesh,
        model.mesh
    );
    let unnamed = load_bytes("thing", &binary("a"), &mut nothing, &LoadOptions::default());
    assert_eq!(unnamed.unwrap().mesh, model.mesh);
}

#[test]
fn facets_are_smoothed_where_that_is_asked() {
    let options = LoadOptions {
        smooth_degrees: Some(100.0),
        ..LoadOptions::default()
    };
    let model = load_bytes("thing.stl", &binary("a"), &mut nothing, &options).unwrap();
    assert_eq!((model.mesh.positions.len(), model.is_smoothed), (6, true));
}

#[test]
fn each_solid_of_a_text_is_a_part() {
    let two = format!("{}{}", text(), text().replace("tent", "my other tent"));
    let model = read(two.as_bytes());
    assert_eq!(model.parts, ["tent", "my other tent"]);
    assert_eq!(model.mesh.triangle_part, [0, 0, 0, 0, 1, 1, 1, 1]);
}

#[test]
fn broken_facets_are_left_out_and_said() {
    let cut = text();
    let cut = &cut[..cut.rfind("vertex").unwrap()];
    let model = read(cut.as_bytes());
    assert_eq!(model.mesh.triangles.len(), 3);
    assert_eq!(
        model.warnings,
        ["The file ends in the middle of a facet, which is left out."]
    );
    let odd = text().replacen("vertex 0 0 0e0", "vertex nan 0 -1.#IND", 1);
    let model = read(odd.as_bytes());
    assert_eq!(
        model.warnings,
        ["1 triangle of the model had positions that are no numbers and had to be left out."]
    );
}

#[test]
fn text_is_read_as_programs_write_it() {
    let plain = read(text().as_bytes());
    for (other, name) in [
        (format!("\u{feff}{}", text()), "tent"),
        (format!("# a remark\r\n\r\n// solid\n; more\n{}", text()), "tent"),
        (
            text().replace("endloop", "end loop").replace("endfacet", "end facet"),
            "tent",
        ),
        (text().replace("endsolid tent", "end solid tent"), "tent"),
        (text().replace("endsolid tent\n", ""), "tent"),
        (text().replace("    endloop\n", ""), "tent"),
        (text().replace("    endloop\n  endfacet\n", ""), "tent"),
        (text().replace("endsolid tent", "EndSolid"), "tent"),
        (text().replace('\n', "\r"), "tent"),
        (text().replace('\n', " "), "tent"),
        (text().replace("solid tent\n", "").replace("end", ""), "thing"),
    ] {
        let model = read(other.as_bytes());
        assert_eq!(
            (&model.mesh, &model.parts[..]),
            (&plain.mesh, &[name.to_owned()][..]),
            "{other:?}"
        );
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        let unnamed = load_bytes("thing", other.as_bytes(), &mut nothing, &LoadOptions::default());
        assert_eq!(unnamed.unwrap().mesh, plain.mesh);
    }
}

#[test]
fn a_number_of_facets_that_does_not_fit_the_size_is_told() {
    let whole = binary("a");
    let counted = |count: u32, more: &[u8]| [&whole[..80], &count.to_le_bytes(), &whole[84..], more].concat();
    for (bytes, triangles, sentence) in [
        (
            counted(0, &[]),
            4,
            "The file says that it has 0 facets, and has 4; these are read.",
        ),
        (
            counted(u32::MAX, &[]),
            4,
            "The file says that it has 4294967295 facets, and has 4; these are read.",
        ),
        (
            counted(3, &[]),
            3,
            "The file goes on behind the 3 facets that it says it has; what follows is left out.",
        ),
    ] {
        let model = read(&bytes);
        assert_eq!(model.mesh.triangles.len(), triangles);
        assert_eq!(model.warnings, [sentence]);
    }
    let trailed = read(&counted(4, b"made by hand"));
    assert!(trailed.mesh.triangles.len() == 4 && trailed.warnings.is_empty());
}

#[test]
fn each_fault_has_its_sentence() {
    let whole = binary("a");
    for (bytes, sentence) in [
        (
            whole[..200].to_vec(),
            "the file is damaged: it promises 4 facets and has 2; it was cut off",
        ),
        (
            b"hello".to_vec(),
            "the file is damaged: it is no STL file: it does not begin with `solid`, and is too short for a binary one",
        ),
        (
            b"solid a\nfacet\nvertex 1 2 x\n".to_vec(),
            "the file is damaged: line 3: `vertex` needs 3 numbers",
        ),
        (b"solid a\nendsolid a\n".to_vec(), "it has no triangles"),
        ([&whole[..80], &[0; 4]].concat(), "it has no triangles"),
    ] {
        assert_eq!(said("a.stl", &bytes), format!("a.stl: {sentence}"));
    }
}

#[test]
fn colors_of_facets_are_told() {
    // Bit 15 of the last two bytes of a facet says that the others are a color of VisCAM or SolidView.
    let mut marked = binary("made by hand");
    let last = marked.len() - 1;
    marked[last] = 0x80;
    let lines = text().replace("    outer loop", "    color 0.5 0.25 1\n    outer loop");
    let expected = read(&binary("made by hand"));
    assert!(expected.warnings.is_empty(), "other bits are no colors");
    for bytes in [binary("COLOR=rgba"), marked, lines.into_bytes()] {
        let model = read(&bytes);
        assert_eq!(
            model.warnings,
            ["The colors of facets, which some programs add to the format, are left out."]
        );
        assert_eq!(model.mesh, expected.mesh);
    }
}
