//! Material libraries of OBJ files.

use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::{Model, TextureRef, Wrap};

use crate::promises;

/// Two triangles with the materials `a` and `b` of a library.
fn read(library: &str) -> Model {
    read_named(library, "a")
}

fn read_named(library: &str, name: &str) -> Model {
    let text =
        format!("mtllib own.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl {name}\nf 1/1 2/2 3/3\n");
    let mut beside = |path: &str| match path {
        "own.mtl" => Ok(library.as_bytes().to_vec()),
        "paint.png" | "other.png" | "my paint.png" | "-dashed.png" => Ok(vec![1, 2, 3]),
        _ => Err("there is no such file".to_string()),
    };
    let model = load_bytes("thing.obj", text.as_bytes(), &mut beside, &LoadOptions::default()).unwrap();
    promises::check(&model);
    model
}

const INVISIBLE: &str = "The file has material `a` invisible; it is taken as opaque.";

#[test]
fn a_material_that_nobody_would_see_is_opaque() {
    for (statements, alpha, warnings) in [
        ("Tr 1.000000", 1.0, &[INVISIBLE][..]),
        ("d 0", 1.0, &[INVISIBLE]),
        ("Tr 1\nmap_Kd paint.png", 1.0, &[INVISIBLE]),
        ("d 1\nTr 1", 1.0, &[]),
        ("Tr 1\nd 1", 1.0, &[]),
        ("Tr 0", 1.0, &[]),
        ("Tr 0.25", 0.75, &[]),
        ("d 0.5\nTr 1", 0.5, &[]),
        ("d -halo 0.5", 0.5, &[]),
    ] {
        let model = read(&format!("newmtl a\nKd 1 1 1\n{statements}\n"));
        assert_eq!(model.materials[0].base_color_factor[3], alpha, "{statements}");
        assert_eq!(model.materials[0].ignores_alpha, !warnings.is_empty(), "{statements}");
        assert_eq!(model.warnings, warnings, "{statements}");
    }
}

#[test]
fn opacity_is_read_from_the_base_colors_own_picture() {
    let model = read("newmtl a\nmap_d paint.png\nmap_Kd paint.png\n");
    assert_eq!((model.materials[0].ignores_alpha, model.warnings.len()), (false, 0));
    let model = read("newmtl a\nmap_d other.png\nmap_Kd paint.png\n");
    assert!(model.materials[0].ignores_alpha);
    assert_eq!(
        model.warnings,
        ["The opacity map of material `a` is left out: opacity is read from the alpha of its base color's picture."]
    );
}

/// Coordinates of a picture, u and v upward, for those of a vertex.
fn looked_up(texture: &TextureRef, [u, v]: [f32; 2]) -> [f32; 2] {
    let [x, y] = texture
        .transform
        .map(|[by_u, by_v, more]| by_u * u + by_v * (1.0 - v) + more);
    [x, 1.0 - y]
}

#[test]
fn scale_and_offset_of_a_picture_are_applied_as_other_programs_do() {
    // Blender and three.js: coordinate × scale + offset, v upward.
    for (options, expected) in [
        ("", [0.25, 0.5]),
        ("-s 2 2 1 -o 0.25 0 0", [0.75, 1.0]),
        ("-o 0.5 0.125 -s 2 3", [1.0, 1.625]),
        ("-S 2 -O 0 1", [0.5, 1.5]),
        ("-s 2 -o 0,25 0", [0.75, 0.5]),
        (
            "-mm 0 1 -blendu on -blendv on -cc off -t 0 0 0 -texres 512 -colorspace sRGB",
            [0.25, 0.5],
        ),
    ] {
        let model = read(&format!("newmtl a\nmap_Kd {options} my paint.png # as it was\n"));
        let texture = model.materials[0].base_color.as_ref().unwrap();
        assert_eq!(looked_up(texture, [0.25, 0.5]), expected, "{options}");
        assert_eq!(model.images[0].name, "my paint.png", "{options}");
        assert_eq!(
            model.warnings.len(),
            usize::from(options.contains(',')),
            "{:?}",
            model.warnings
        );
    }
    assert_eq!(
        read("newmtl a\nmap_Kd -CLAMP on paint.png\n").materials[0]
            .base_color
            .as_ref()
            .unwrap()
            .wrap,
        [Wrap::Clamp; 2]
    );
    let behind = read("newmtl a\nmap_Kd my paint.png -s 2 2 -clamp on\n");
    let texture = behind.materials[0].base_color.as_ref().unwrap();
    assert_eq!(
        (looked_up(texture, [0.25, 0.5]), texture.wrap),
        ([0.5, 1.0], [Wrap::Clamp; 2])
    );
    assert_eq!(behind.images[0].name, "my paint.png");
    assert_eq!(read("newmtl a\nmap_Kd -dashed.png\n").images[0].name, "-dashed.png");
}

#[test]
fn options_that_are_not_applied_are_told_for_each_map() {
    for keyword in ["map_Kd", "map_Ke", "map_Pr", "map_Pm", "norm"] {
        for options in [
            "-mm 0.1 2",
            "-t 1 1",
            "-blendu off",
            "-cc on",
            "-imfchan g",
            "-boost 2",
            "-type sphere",
        ] {
            let model = read(&format!("newmtl a\n{keyword} {options} paint.png\n"));
            assert_eq!(
                model.warnings,
                [format!(
                    "The options `{options}` of `{keyword}` of material `a` are left out."
                )]
            );
            assert_eq!(model.images.len(), 1);
        }
    }
    let model = read("newmtl a\nmap_Kd -mm 0.1 2 -cc on -s 2 paint.png\n");
    assert_eq!(
        model.warnings,
        ["The options `-mm 0.1 2`, `-cc on` of `map_Kd` of material `a` are left out."]
    );
}

#[test]
fn keywords_are_read_in_any_case() {
    let plain = read("newmtl a\nKd 0.5 0.5 0.5\nKe 1 2 3\nPr 0.25\nPm 1\nd 0.5\nmap_Kd -s 2 2 paint.png\n");
    let library = "NEWMTL a\nkd 0.5 0.5 0.5\nKE 1 2 3\npr 0.25\nPM 1\nD 0.5\nmap_KD -s 2 2 paint.png\n";
    assert_eq!(read(library).materials, plain.materials);
    assert_eq!(read(library).images.len(), 1);
    assert_eq!(read(&library.replace('\n', "\r")).materials, plain.materials);
    assert_eq!(read(&format!("\u{feff}{library}")).materials, plain.materials);
}

#[test]
fn a_normal_map_is_read_with_its_strength() {
    let model = read("newmtl a\nnorm -bm 0.5 paint.png\n");
    let material = &model.materials[0];
    assert!(material.normal.is_some() && model.warnings.is_empty());
    assert_eq!(material.normal_scale, 0.5);
}

#[test]
fn what_a_material_has_and_is_not_read_is_told() {
    for (statement, told) in [
        (
            "map_Bump -bm 2 paint.png",
            "`map_Bump` of material `a` is left out; glTF carries such maps.",
        ),
        (
            "disp paint.png",
            "`disp` of material `a` is left out; glTF carries such maps.",
        ),
        ("map_Ks paint.png", "`map_Ks` of material `a` is left out."),
        ("map_RMA paint.png", "`map_RMA` of material `a` is left out."),
        ("refl -type sphere paint.png", "`refl` of material `a` is left out."),
        ("map_Ka other.png", "`map_Ka` of material `a` is left out."),
        (
            "map_Kd -s 1 1 1",
            "`map_Kd` of material `a` names no picture and is left out.",
        ),
        ("Pc 0.5", "`Pc` of material `a` is left out; glTF carries such values."),
        (
            "Kd spectral a.rfl",
            "`Kd` of material `a` is no color of three numbers and is left out.",
        ),
        ("Pr rough", "`Pr` of material `a` is no number and is left out."),
        (
            "shine 3\nglow\nshine 4",
            "The material library own.mtl has statements that are not known and are left out, the first in line 2: `shine`, \
             `glow`.",
        ),
    ] {
        assert_eq!(read(&format!("newmtl a\n{statement}\n")).warnings, [told]);
    }
    // What all programs write is no reason for a warning.
    let usual = "newmtl a # a remark\nKa 1 1 1\nKs 0 0 0\nNs 10\nNi 1.5\nTf 1 1 1\nillum 2\nsharpness 60\nmap_aat on\nPs 0\nPc 0\n\
        Pcr 0\naniso 0\nanisor 0\nmap_Kd paint.png\nmap_Ka paint.png # the same\n# map_Ks a\\\n";
    let model = read(usual);
    assert_eq!(
        (model.warnings.len(), model.images.len()),
        (0, 1),
        "{:?}",
        model.warnings
    );
}

#[test]
fn remarks_behind_the_names_of_materials_are_none_of_them() {
    for (library, name) in [
        ("newmtl a # first\n", "a"),
        ("newmtl a\n", "a # first"),
        ("newmtl a\n", "a #first"),
        ("newmtl a #25\n", "a #25"),
    ] {
        let model = read_named(&format!("{library}Kd 0.5 0.5 0.5\n"), name);
        assert_eq!(model.materials[0].base_color_factor[0], 0.5, "{library:?} {name:?}");
        assert!(model.warnings.is_empty());
    }
}

#[test]
fn a_library_of_the_models_own_name_has_what_no_other_has() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n";
    let taken = "Materials are in no library that the file names and that could be read; those of thing.mtl beside it are taken.";
    for (head, told) in [
        ("", true),
        ("mtllib renamed.mtl\n", true),
        ("mtllib \"my own.mtl\"\n", false),
        ("mtllib thing.mtl\n", false),
    ] {
        let mut beside = |path: &str| match path {
            "thing.mtl" | "my own.mtl" => Ok(b"newmtl a\nKd 1 0 0\n".to_vec()),
            _ => Err("there is no such file".to_string()),
        };
        let text = format!("{head}{square}");
        let model = load_bytes("thing.obj", text.as_bytes(), &mut beside, &LoadOptions::default()).unwrap();
        assert_eq!(model.materials[0].base_color_factor, [1.0, 0.0, 0.0, 1.0], "{head}");
        assert_eq!(
            model.warnings.iter().any(|warning| warning == taken),
            told,
            "{:?}",
            model.warnings
        );
    }
}

#[test]
fn a_picture_of_each_tile_is_told() {
    let model = read("newmtl a\nmap_Kd paint.<UDIM>.png");
    assert_eq!(
        model.warnings,
        [
            "The picture paint.<UDIM>.png cannot be read: it stands for a picture of each UV tile (UDIM), and one for all is read."
        ]
    );
}

#[test]
fn values_out_of_their_range_are_told_and_clamped() {
    let model = read("newmtl a\nKd 255 -0.5 0.25\nPr 3\nKe 4 0 0\n");
    let material = &model.materials[0];
    assert_eq!(material.base_color_factor, [1.0, 0.0, 0.25, 1.0]);
    assert_eq!(
        (material.roughness_factor, material.emission_factor),
        (1.0, [4.0, 0.0, 0.0])
    );
    assert_eq!(
        model.warnings,
        [
            "`Kd` of material `a` cannot be 255; 1 is taken.",
            "`Kd` of material `a` cannot be -0.5; 0 is taken.",
            "`Pr` of material `a` cannot be 3; 1 is taken.",
        ]
    );
    assert!(
        read("newmtl a\nKd 1.0001 0 0\n").warnings.is_empty(),
        "rounding is no fault"
    );
}

#[test]
fn a_picture_replaces_the_color_beside_it() {
    for library in [
        "newmtl a\nKd 0 0 0\nmap_Kd paint.png\n",
        "newmtl a\nmap_Kd paint.png\nKd 0.5 0.5 0.5\n",
    ] {
        assert_eq!(read(library).materials[0].base_color_factor, [1.0; 4], "{library}");
    }
}
