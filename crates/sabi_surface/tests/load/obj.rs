//! OBJ files and their material libraries.

use sabi_surface::load::{LoadError, LoadOptions, load_bytes};
use sabi_surface::model::{Model, ModelMaterial, Wrap};

use crate::promises;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn read(text: &str) -> Result<Model, LoadError> {
    read_with(text, "")
}

fn read_with(text: &str, library: &str) -> Result<Model, LoadError> {
    let mut beside = |path: &str| match path {
        "my materials.mtl" => Ok(library.as_bytes().to_vec()),
        "paint.png" | "rough.png" => Ok(vec![1, 2, 3]),
        _ => Err("there is no such file".to_string()),
    };
    let model = load_bytes("thing.obj", text.as_bytes(), &mut beside, &LoadOptions::default())?;
    promises::check(&model);
    Ok(model)
}

#[test]
fn faces_read_the_same_however_they_are_written() {
    let plain = read(&format!("{SQUARE}f 1 2 3 4\n")).unwrap();
    assert_eq!(plain.mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(plain.mesh.normals, [[0.0, 0.0, 1.0]; 4]);
    assert_eq!(
        (plain.stem.as_str(), &plain.parts[..]),
        ("thing", &["thing".to_string()][..])
    );
    for text in [
        format!("{SQUARE}f -4 -3 -2 -1"),
        format!("{SQUARE}f 1// 2// 3// 4//\n"),
        format!("{SQUARE}f 1 2 \\\n 3 4\n"),
        format!("{SQUARE}f 1 2 3 4\n").replace('\n', "\r\n"),
        format!("{SQUARE}f 1 2 \\\n 3 4\n").replace('\n', "\r\n"),
        format!("{SQUARE}f 1 2 3 4\n").replace('\n', "\r"),
        format!("f 1 2 3 4\n{SQUARE}"),
        format!("# a remark\n\n  \t{SQUARE}\tf  1\t2 3 4  \nunknown statement\n"),
        format!("\u{feff}{SQUARE}f 1 2 3 4"),
        format!("{SQUARE}f 1/0/0 2/0/0 3/0/0 4/0/0\n"),
        format!("{SQUARE}f 1// 2// 3// 4//\n"),
        format!("{SQUARE}f 1, 2, 3, 4\n"),
        format!("{SQUARE}f 1.0 2.000 3. 4\n"),
    ] {
        assert_eq!(read(&text).unwrap().mesh, plain.mesh, "{text:?}");
    }
    let wide: Vec<u8> = format!("\u{feff}{SQUARE}f 1 2 3 4")
        .encode_utf16()
        .flat_map(u16::to_be_bytes)
        .collect();
    let mut nothing = crate::builder::nothing;
    assert_eq!(
        load_bytes("a.obj", &wide, &mut nothing, &LoadOptions::default())
            .unwrap()
            .mesh,
        plain.mesh
    );
}

#[test]
fn texture_coordinates_turn_to_v_down() {
    let model = read(&format!("{SQUARE}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n")).unwrap();
    assert_eq!(model.mesh.uvs, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
    assert_eq!(model.mesh.tangents, [[1.0, 0.0, 0.0, 1.0]; 4]);
}

#[test]
fn corners_that_differ_in_anything_are_vertices_of_their_own() {
    let model = read(&format!(
        "{SQUARE}vt 0 0\nvt 1 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1/2/1 3/1/1 4/1/1\n"
    ))
    .unwrap();
    assert_eq!(model.mesh.triangles, [[0, 1, 2], [3, 2, 4]]);
}

/// Two squares that meet at the y axis, turned by `degrees` against each other.
fn fold(degrees: f32, statements: [&str; 2]) -> Model {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let [before, between] = statements;
    read(&format!(
        "v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv {cos} 0 {z}\nv {cos} 1 {z}\n{before}f 1 2 3 4\n{between}f 2 5 6 3\n",
        z = -sin
    ))
    .unwrap()
}

#[test]
fn missing_normals_are_smooth_up_to_the_crease_or_as_the_groups_say() {
    for (degrees, statements, vertices) in [
        (60.0, ["", ""], 6),
        (90.0, ["", ""], 8),
        (60.0, ["s off\n", ""], 12),
        (90.0, ["s 1\n", ""], 6),
        (20.0, ["s 1\n", "s 2\n"], 8),
    ] {
        let mesh = fold(degrees, statements).mesh;
        let flat = usize::from(statements[0] == "s off\n") * 4;
        assert_eq!(mesh.positions.len() + flat, vertices, "{degrees}° {statements:?}");
    }
    let mesh = fold(60.0, ["", ""]).mesh;
    let shared = mesh.normals[mesh.positions.iter().position(|at| *at == [0.0; 3]).unwrap()];
    let expected = glam::Vec3::new(0.5, 0.0, 0.75f32.sqrt());
    assert!(glam::Vec3::from(shared).abs_diff_eq(expected, 1e-6), "{shared:?}");
}

#[test]
fn each_object_is_a_part_and_groups_of_one_name_are_one() {
    for (statements, parts, of_triangles) in [
        (
            ["", "o unused\ng left wing\n", "g tail\n", "g left wing\n"],
            &["thing", "left wing", "tail"][..],
            [0, 1, 2, 1],
        ),
        (
            ["o Cube\n", "o Cube\n", "o Other\n", "o Cube\n"],
            &["Cube", "Cube", "Other", "Cube"],
            [0, 1, 2, 3],
        ),
        (
            ["o Cube\ng Cube\n", "o Cube\ng Cube\n", "g other\n", "g Cube\n"],
            &["Cube", "Cube", "other"],
            [0, 1, 2, 1],
        ),
        (
            ["o\n", "o Cube # the first\n", "g Cube #2\n", "g #\n"],
            &["thing", "Cube", "Cube #2", "thing"],
            [0, 1, 2, 3],
        ),
    ] {
        let faces = statements.map(|statement| format!("{statement}f 1 2 3\n")).concat();
        let model = read(&format!("{SQUARE}{faces}")).unwrap();
        assert_eq!(model.parts, parts, "{statements:?}");
        assert_eq!(model.mesh.triangle_part, of_triangles, "{statements:?}");
    }
}

#[test]
fn remarks_may_stand_behind_every_statement_and_end_in_a_backslash() {
    let plain = "o thing\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\ns 1\nf 1/1/1 2/2/1 3/3/1\nf 1 3 4\nl 1 2\n";
    let expected = read(plain).unwrap();
    for remark in [" # quad", " #quad", "\t# C:\\props\\", " # 1 2 3 \\"] {
        let commented = plain.replace('\n', &format!("{remark}\n"));
        // Without a space the remark could belong to the name.
        let commented = commented
            .replace("thing #quad", "thing")
            .replace("usemtl a #quad", "usemtl a");
        let model = read(&commented).unwrap();
        assert_eq!(
            (&model.mesh, &model.parts),
            (&expected.mesh, &expected.parts),
            "{remark:?}"
        );
        assert_eq!(model.warnings, expected.warnings, "{remark:?}");
        assert_eq!(model.materials, expected.materials, "{remark:?}");
    }
    for remark in ["# group C:\\props\\", "#\\", "  # \\"] {
        let commented = plain.replace('\n', &format!("\n{remark}\n"));
        assert_eq!(read(&commented).unwrap().mesh, expected.mesh, "{remark:?}");
    }
}

#[test]
fn keywords_are_read_in_any_case_and_unknown_ones_are_told() {
    let text = format!("{SQUARE}vt 0 0\nusemtl a\ng wing\nf 1/1 2/1 3/1\n");
    let model = read(
        &text
            .replace("v ", "V ")
            .replace("vt", "VT")
            .replace("f 1", "F 1")
            .replace("g w", "G w"),
    )
    .unwrap();
    assert_eq!(model.mesh, read(&text).unwrap().mesh);
    assert_eq!(model.parts, ["wing"]);
    let model = read(&format!("lod 1\nvp 0 0\nbevel on\n{text}glow 1\nVC 1 1 1\nglow 2\n")).unwrap();
    assert_eq!(
        model.warnings,
        ["The file has statements that are not known and are left out, the first in line 12: `glow`, `VC`."]
    );
    let many: String = ["a", "b", "c", "d", "e", "h", "i"]
        .map(|word| format!("{word} 1\n"))
        .concat();
    assert_eq!(
        read(&format!("{text}{many}")).unwrap().warnings,
        [
            "The file has statements that are not known and are left out, the first in line 9: `a`, `b`, `c`, `d`, `e` and others."
        ]
    );
    assert_eq!(
        read(&format!("{text}call other.obj\n")).unwrap().warnings,
        ["Other files and commands that the file calls are left out."]
    );
}

#[test]
fn colors_of_vertices_are_read_in_all_their_forms() {
    // sRGB 0.5 and 128 of 255 are 0.214 and 0.216 in linear light (IEC 61966-2-1).
    let orange = |text: &str| {
        let model = read(text).unwrap();
        let [r, g, b, a] = model.mesh.colors[0];
        assert_eq!([r, b], [1.0, 0.0], "{text}");
        assert!((g - 0.215).abs() < 2e-3, "{text}: {g}");
        assert_eq!(model.mesh.colors[1], [1.0; 4], "{text}");
        (a, model.warnings)
    };
    let faces = "f 1 2 3\n";
    assert_eq!(
        orange(&format!("v 0 0 0 1 0.5 0 0.25\nv 1 0 0 1 1 1 1\nv 0 1 0\n{faces}")),
        (0.25, vec![])
    );
    assert_eq!(
        orange(&format!("v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0\n{faces}")),
        (1.0, vec![])
    );
    let codes = ["The colors of vertices reach above 1; they are taken as codes of 0 to 255.".to_owned()];
    assert_eq!(
        orange(&format!("v 0 0 0 255 128 0\nv 1 0 0\nv 0 1 0\n{faces}")),
        (1.0, codes.to_vec())
    );
    let plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    assert_eq!(
        orange(&format!("{plain}#MRGB ffff8000ffffffff\n#MRGB 00ffffff\n{faces}")),
        (1.0, vec![])
    );
    assert_eq!(orange(&format!("#MRGB 00FF8000\n{plain}{faces}")), (1.0, vec![]));
    let (_, warnings) = orange(&format!("{plain}#MRGB ffff8000ffffffffzz\n{faces}"));
    assert_eq!(
        warnings,
        ["Colors in a remark `#MRGB` are damaged; some vertices have none, or that of another."]
    );
    let bright = read(&format!("v 0 0 0 1.5 0.5 -0.5\nv 1 0 0\nv 0 1 0\n{faces}")).unwrap();
    assert_eq!(
        bright.warnings,
        ["Some colors of vertices are below 0 or above full intensity; the nearest possible ones are taken."]
    );
    let weighted = read(&format!("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\n{faces}")).unwrap();
    assert!(weighted.mesh.colors.is_empty());
}

#[test]
fn materials_come_from_the_library_in_its_order() {
    let library = "newmtl metal\nKd 0.1 0.2 0.3\nPr 0.25\nPm 1\nKe 1 2 3\nd 0.5\nmap_Bump -bm 2 b.png\n\
        newmtl paint\nKd 0.8 0.8 0.8\nmap_Kd -clamp on -s 1 1 -o 0.5 paint.png\nnewmtl never\n";
    let faces = "f 1 2 3\nusemtl lost\nf 1 2 3\nusemtl paint\nf 1 2 3\nusemtl metal\nf 1 2 3\n";
    let model = read_with(&format!("mtllib my materials.mtl\n{SQUARE}{faces}"), library).unwrap();
    let names: Vec<&str> = model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["metal", "paint", "lost", ""]);
    assert_eq!(model.mesh.triangle_material, [3, 2, 1, 0]);
    let metal = ModelMaterial {
        name: "metal".into(),
        base_color_factor: [0.1, 0.2, 0.3, 0.5],
        metallic_factor: 1.0,
        roughness_factor: 0.25,
        emission_factor: [1.0, 2.0, 3.0],
        ..ModelMaterial::default()
    };
    assert_eq!(model.materials[0], metal);
    let paint = &model.materials[1];
    assert_eq!((paint.base_color_factor, paint.metallic_factor), ([1.0; 4], 0.0));
    let unknown = [0.5, 0.5, 0.5, 1.0];
    assert_eq!(
        [&model.materials[2], &model.materials[3]].map(|material| material.base_color_factor),
        [unknown; 2],
        "a surface without a color is gray, so that its form is seen"
    );
    assert_eq!(paint.base_color.as_ref().unwrap().wrap, [Wrap::Clamp; 2]);
    assert_eq!((model.images.len(), model.images[0].name.as_str()), (1, "paint.png"));
    assert_eq!(
        model.warnings,
        [
            "`map_Bump` of material `metal` is left out; glTF carries such maps.",
            "Material `lost` is in no material library that could be read; it gets plain values.",
        ]
    );
}

#[test]
fn roughness_and_metallic_have_pictures_of_their_own() {
    let library = "newmtl rust\nmap_Pr rough.png\nPr 0.25\nPm 0.5\nmap_Pm rough.png\n";
    let model = read_with(
        &format!("mtllib my materials.mtl\nusemtl rust\n{SQUARE}f 1 2 3\n"),
        library,
    )
    .unwrap();
    let rust = &model.materials[0];
    assert!(rust.roughness.is_some() && rust.metallic == rust.roughness && rust.metallic_roughness.is_none());
    assert_eq!(
        (rust.roughness_factor, rust.metallic_factor),
        (1.0, 1.0),
        "a picture replaces the number"
    );
    assert_eq!((model.images.len(), model.warnings.len()), (1, 0));
}

#[test]
fn vertex_colors_are_taken_as_srgb() {
    let model = read("v 0 0 0 1 0.5 0\nv 1 0 0 1 1 1\nv 0 1 0\nf 1 2 3\n").unwrap();
    assert!((model.mesh.colors[0][1] - 0.214_041).abs() < 1e-5);
    assert_eq!(model.mesh.colors[1..], [[1.0; 4]; 2]);
}

#[test]
fn what_is_left_out_is_said() {
    let text = format!(
        "mtllib gone.mtl\n{SQUARE}vt 0 0\nf 1/1 2/1 3/1\nusemtl a\nf 1 2 3\nf 1 2\nl 1 2\nf 1/9 2/9 3/9\nv nan 0 0\nf 1/1 2/1 5/1\n"
    );
    let model = read(&text).unwrap();
    let bare: Vec<String> = model
        .without_uvs
        .iter()
        .map(|at| model.materials[*at as usize].label())
        .collect();
    assert_eq!(bare, ["material `a`"]);
    assert_eq!(
        model.warnings,
        [
            "Faces with fewer than 3 corners are left out.",
            "Points and lines are left out.",
            "Faces name texture coordinates or normals that the file does not have.",
            "1 triangle of the model had positions that are no numbers and had to be left out.",
            "The material library gone.mtl cannot be read: there is no such file.",
            "Material `a` is in no material library that could be read; it gets plain values.",
        ]
    );
}

#[test]
fn a_line_with_millions_of_continuations_is_read_in_linear_time() {
    // Quadratic work on this would take a quarter of an hour.
    let text = format!("{SQUARE}f 1 2 3 {}4\n", "\\\n".repeat(2_000_000));
    assert_eq!(read(&text).unwrap().mesh.triangles.len(), 2);
}

#[test]
fn different_latin_1_names_stay_different() {
    let text = [
        SQUARE.as_bytes(),
        &b"usemtl T\xfcr\nf 1 2 3\nusemtl T\xf6r\nf 1 2 3\n"[..],
    ]
    .concat();
    let model = load_bytes("a.obj", &text, &mut crate::builder::nothing, &LoadOptions::default()).unwrap();
    let names: Vec<&str> = model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["T\u{fc}r", "T\u{f6}r"]);
}

#[test]
fn a_space_in_a_library_name_may_stand_behind_a_backslash() {
    let mut asked = Vec::new();
    let mut beside = |name: &str| {
        asked.push(name.to_string());
        Err("there is no such file".to_string())
    };
    let text = format!("mtllib a.mtl my\\ own.mtl\n{SQUARE}f 1 2 3\n");
    load_bytes("a.obj", text.as_bytes(), &mut beside, &LoadOptions::default()).unwrap();
    assert_eq!(asked[1..], ["a.mtl", "my own.mtl"]);
}

#[test]
fn each_fault_has_its_sentence() {
    for (text, sentence) in [
        ("v 0 0\n", "the file is damaged: line 1: `v` needs 3 numbers"),
        (
            "\r\n# remark\r\nv 0 0 zero\r\n",
            "the file is damaged: line 3: `zero` is not a number",
        ),
        ("v 0 0 0\nf 1 2 3\n", "the file is damaged: a face names vertex 2 of 1"),
        (
            "f 0 1 2\n",
            "the file is damaged: line 1: an index is 0, and they count from 1",
        ),
        (
            "v 0 0 0\nf -2 1 1\n",
            "the file is damaged: line 2: the index -2 reaches out of the file",
        ),
        (
            "f 99999999999 1 1\n",
            "the file is damaged: line 1: the index 99999999999 reaches out of the file",
        ),
        (
            "f /1 /2 /3\n",
            "the file is damaged: line 1: the corner `/1` names no vertex",
        ),
        ("f a b c\n", "the file is damaged: line 1: `a` is not an index"),
        ("f 1.5 2 3\n", "the file is damaged: line 1: `1.5` is not an index"),
        (
            "hello\n",
            "it has no triangles; The file has statements that are not known and are left out, the first in line 1: `hello`",
        ),
        (
            "v 0 0 0\nv 0 0 1\n",
            "it has no triangles; it is a cloud of points without faces; make a mesh of them first",
        ),
        (
            "v 0 0 0\nv 0 0 0\nl 1 2\n",
            "it has no triangles; Points and lines are left out",
        ),
    ] {
        assert_eq!(
            read(text).unwrap_err().to_string(),
            format!("thing.obj: {sentence}"),
            "{text:?}"
        );
    }
    let options = LoadOptions {
        uv_set: 1,
        ..LoadOptions::default()
    };
    let text = format!("{SQUARE}vt 0 0\nf 1/1 2/1 3/1\n");
    let error = load_bytes("a.obj", text.as_bytes(), &mut crate::builder::nothing, &options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.obj: it has no UV set 1; OBJ files have set 0 alone"
    );
}

#[test]
fn texture_maps_of_the_first_version_are_told() {
    let faces = "f 1 2 3\n";
    let told = [
        "The texture maps of `maplib` and `usemap`, an old way to show pictures, are left out; those of materials are read.",
    ];
    for statements in ["maplib a.mpc\nusemap wood\n", "usemap wood\n", "MAPLIB a.mpc\n"] {
        assert_eq!(read(&format!("{statements}{SQUARE}{faces}")).unwrap().warnings, told);
    }
    assert!(
        read(&format!("usemap off\n{SQUARE}{faces}"))
            .unwrap()
            .warnings
            .is_empty()
    );
}
