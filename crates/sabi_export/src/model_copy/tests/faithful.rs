//! Content of a file that a copy must preserve, and content that it must not contain.

use super::super::container::tests::glb;
use super::super::wrap::{CLAMP_TO_EDGE, REPEAT};
use super::*;

#[test]
fn a_buffer_with_a_too_small_declared_length_loses_nothing() {
    let (mut document, binary) = document();
    document["buffers"][0]["byteLength"] = json!(120);
    let finished = copied("it.glb", &[("it.glb", &glb(&document, &binary))], &[(1, all_maps())]);
    let (_, is_view) = parts(&finished.copy.bytes);
    assert_eq!((is_view(1), is_view(4)), (triangle(), picture("glass")));
}

#[test]
fn maps_lie_beside_a_glb_whose_first_buffer_is_a_file() {
    let (mut document, binary) = document();
    document["buffers"][0]["uri"] = json!("far.bin");
    let file = glb(&document, b"what nobody asks for");
    let finished = copied(
        "it.glb",
        &[("it.glb", &file), ("far.bin", &binary)],
        &[(1, flat_maps())],
    );
    let (is, _) = parts(&finished.copy.bytes);
    assert_eq!(is["bufferViews"], document["bufferViews"], "no view is new");
    let buffer = json!({ "byteLength": binary.len(), "uri": "it.bin" });
    assert_eq!(is["buffers"], json!([buffer]));
    assert_eq!(is["images"][0]["uri"], "new%20color.png");
    let beside: Vec<&str> = finished.beside.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(beside, ["new packed.png", "it.bin"]);
    assert!(finished.copy.bytes.ends_with(b"\x14\0\0\0BIN\0what nobody asks for"));
}

#[test]
fn only_files_in_the_folder_of_the_model_are_copied() {
    let outside = tempfile::tempdir().unwrap();
    let folder = outside.path().join("model");
    fs::create_dir_all(folder.join("maps")).unwrap();
    let (mut document, binary) = document();
    let secret = outside.path().join("secret.png");
    for (path, bytes) in [
        (secret.clone(), picture("secret")),
        (folder.join("maps/in.png"), picture("in")),
        (folder.join("it.bin"), binary),
    ] {
        fs::write(path, bytes).unwrap();
    }
    let mut uris = vec![
        "../secret.png".to_owned(),
        "%2e%2e/secret.png".to_owned(),
        "maps/../../secret.png".to_owned(),
        secret.to_str().unwrap().to_owned(),
    ];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&secret, folder.join("link.png")).unwrap();
        uris.push("link.png".to_owned());
    }
    let inside = ["maps/in.png", "maps/../maps/in.png"];
    document["buffers"][0]["uri"] = json!("it.bin");
    let first = document["images"].as_array().unwrap().len();
    for uri in uris.iter().map(String::as_str).chain(inside) {
        edit::push(&mut document, "images", json!({ "uri": uri }));
    }
    let path = folder.join("it.gltf");
    fs::write(&path, document.to_string()).unwrap();
    let model = load(&path, &LoadOptions::default()).unwrap();
    let copy = ModelCopy::open(source(&path, &model), &BTreeSet::new(), CopyOptions::default()).unwrap();
    let finished = copy.finish(BTreeMap::new(), &|_| false).unwrap();
    let is: Json = serde_json::from_slice(&finished.copy.bytes).unwrap();
    for (at, uri) in uris.iter().enumerate() {
        assert_eq!(is["images"][first + at]["uri"], *uri);
        let sentence = format!(
            "the copy of the model names {uri} as the model does, but it was not copied: {} is outside of the folder of the \
             file that names it and of the folders that you trust",
            secret.canonicalize().unwrap().display()
        );
        assert_eq!(finished.warnings[at], sentence);
    }
    assert_eq!(finished.warnings.len(), uris.len());
    let beside: Vec<&str> = finished.beside.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(beside, ["it.bin", "in.png", "in_2.png"]);
    assert!(finished.beside.iter().all(|file| file.bytes != picture("secret")));
}

#[test]
fn a_model_counts_as_gltf_if_its_reader_says_so() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.1 0.9\nf 1/1 2/2 3/3\n";
    // The OBJ reader ignores unknown statements, so this is an OBJ file although it starts like JSON.
    let file = format!("{{ left by a program }}\n{obj}");
    let finished = copied("it.obj", &[("it.obj", file.as_bytes())], &[]);
    assert_eq!(finished.copy.name, "it.glb");
}

#[test]
fn a_picture_that_gltf_cannot_hold_is_named() {
    let obj =
        "mtllib it.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.1 0.9\nusemtl wood\nf 1/1 2/2 3/3\n";
    let files: [(&str, &[u8]); 3] = [
        ("it.obj", obj.as_bytes()),
        ("it.mtl", b"newmtl wood\nmap_Kd wood.bmp\n"),
        ("wood.bmp", b"BM and so on"),
    ];
    let warnings = copied("it.obj", &files, &[]).warnings;
    let [warning] = &warnings[..] else {
        panic!("{warnings:?}");
    };
    assert!(
        warning
            .starts_with("the copy of the model does not show wood.bmp, a picture of a material that was not baked: "),
        "{warning}"
    );
    assert!(copied("it.obj", &files, &[(0, all_maps())]).warnings.is_empty());
}

#[test]
fn maps_repeat_on_the_materials_whose_uvs_leave_the_square() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0 1.5\nusemtl in\nf 1/1 2/2 3/3\nusemtl out\nf 1/1 2/2 3/3\n\
               f 1/1 2/2 3/4\nusemtl in\nf 1/1 2/2 3/3\n";
    let finished = copied(
        "it.obj",
        &[("it.obj", obj.as_bytes())],
        &[(0, all_maps()), (1, all_maps())],
    );
    let (is, _) = parts(&finished.copy.bytes);
    let wraps = |material: usize| {
        let texture = &is["materials"][material]["normalTexture"]["index"];
        let texture = &is["textures"][texture.as_u64().unwrap() as usize];
        is["samplers"][texture["sampler"].as_u64().unwrap() as usize]["wrapS"].clone()
    };
    assert_eq!([wraps(0), wraps(1)], [json!(CLAMP_TO_EDGE), json!(REPEAT)]);
}

#[test]
fn numbers_are_written_exactly_as_they_were_read() {
    // Numbers with 16 and 17 digits need more than 53 bits, so a fast but inexact parser would change the last digit.
    let numbers = json!([
        0.30000000000000004,
        0.0009221885624698875,
        393.35362306983956,
        9.200864349327219,
        0.00020548525770076122,
        0.00018078399346030394,
        0.00043165554714977484
    ]);
    let (mut document, binary) = document();
    document["extensions"]["EXT_unheard_of"] = numbers.clone();
    let finished = copied("it.glb", &[("it.glb", &glb(&document, &binary))], &[(1, all_maps())]);
    let text = numbers.to_string();
    assert!(
        finished
            .copy
            .bytes
            .windows(text.len())
            .any(|bytes| bytes == text.as_bytes()),
        "{text}"
    );
}

#[test]
fn a_smoothed_model_is_copied_with_the_normals_that_its_maps_were_made_for() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes/cube.glb");
    let options = LoadOptions {
        smooth_degrees: Some(120.0),
        ..LoadOptions::default()
    };
    let model = load(&path, &options).unwrap();
    let copy = ModelCopy::open(source(&path, &model), &BTreeSet::new(), CopyOptions::default()).unwrap();
    let finished = copy.finish(BTreeMap::new(), &|_| false).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let made = folder.path().join("made.glb");
    fs::write(&made, &finished.copy.bytes).unwrap();
    let read = load(&made, &LoadOptions::default()).unwrap();
    let corners = |model: &Model| -> Vec<([f32; 3], [f32; 3])> {
        let mesh = &model.mesh;
        let all = mesh.triangles.iter().flatten().map(|at| *at as usize);
        all.map(|at| (mesh.positions[at], mesh.normals[at].map(|part| (part * 1e5).round())))
            .collect()
    };
    assert_eq!(corners(&model), corners(&read));
    let flat = load(&path, &LoadOptions::default()).unwrap();
    assert_ne!(corners(&flat), corners(&read));
}

/// A GLB file with some triangles of its first primitive turned inside out.
fn with_turned_faces(mut file: Vec<u8>, faces: &[usize]) -> Vec<u8> {
    let text_end = 20 + u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    let document: Json = serde_json::from_slice(&file[20..text_end]).unwrap();
    let indices = document["meshes"][0]["primitives"][0]["indices"].as_u64().unwrap();
    let accessor = &document["accessors"][indices as usize];
    let number = |of: &Json, key: &str| of[key].as_u64().unwrap_or(0) as usize;
    let view = &document["bufferViews"][number(accessor, "bufferView")];
    let size = match number(accessor, "componentType") {
        5121 => 1,
        5123 => 2,
        _ => 4,
    };
    let first = text_end + 8 + number(view, "byteOffset") + number(accessor, "byteOffset");
    for face in faces {
        for byte in 0..size {
            let corner = first + (3 * face + 1) * size + byte;
            file.swap(corner, corner + size);
        }
    }
    file
}

#[test]
fn faces_that_were_turned_look_outward_in_the_copy() {
    let good = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes/cube.glb");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.glb");
    fs::write(&path, with_turned_faces(fs::read(&good).unwrap(), &[0, 3, 7])).unwrap();
    let turning = LoadOptions {
        turns_faces: true,
        ..LoadOptions::default()
    };
    let model = load(&path, &turning).unwrap();
    assert_eq!(model.turned_faces, 3);
    let copy = ModelCopy::open(source(&path, &model), &BTreeSet::new(), CopyOptions::default()).unwrap();
    let finished = copy.finish(BTreeMap::new(), &|_| false).unwrap();
    let made = folder.path().join("made.glb");
    fs::write(&made, &finished.copy.bytes).unwrap();
    let corners = |model: &Model| -> Vec<([f32; 3], [f32; 3], [f32; 2])> {
        let mesh = &model.mesh;
        let all = mesh.triangles.iter().flatten().map(|at| *at as usize);
        all.map(|at| (mesh.positions[at], mesh.normals[at].map(f32::round), mesh.uvs[at]))
            .collect()
    };
    let [was, is] = [&good, &made].map(|path| corners(&load(path, &LoadOptions::default()).unwrap()));
    assert_eq!(is, was);
}

#[test]
fn a_model_that_changed_meanwhile_is_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("it.glb");
    fs::write(&path, super::glb()).unwrap();
    let model = load(&path, &LoadOptions::default()).unwrap();
    let grown = [super::glb(), b" ".to_vec()].concat();
    for (now, why) in [
        (&b"{ \"asset\": {} }"[..], "it was changed while it was read"),
        (&grown, "it has grown since it was read"),
    ] {
        fs::write(&path, now).unwrap();
        let opened = ModelCopy::open(source(&path, &model), &BTreeSet::new(), CopyOptions::default());
        let error = opened.err().unwrap();
        assert_eq!(
            error.to_string(),
            format!("no copy of {} can be made: {why}", path.display())
        );
    }
}

#[test]
fn roughness_and_metallic_that_gltf_would_pack_are_named() {
    let obj =
        "mtllib it.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.1 0.9\nusemtl rust\nf 1/1 2/2 3/3\n";
    let rough = picture("rough");
    let files: [(&str, &[u8]); 3] = [
        ("it.obj", obj.as_bytes()),
        ("it.mtl", b"newmtl rust\nmap_Pr rough.png\nmap_Pm rough.png\n"),
        ("rough.png", &rough),
    ];
    let finished = copied("it.obj", &files, &[]);
    assert_eq!(
        finished.warnings,
        [
            "the copy of the model does not show rough.png, a picture of a material that was not baked: glTF has roughness and \
             metallic in one picture; bake that material as well"
        ]
    );
    let material = &parts(&finished.copy.bytes).0["materials"][0]["pbrMetallicRoughness"];
    assert_eq!(material["metallicFactor"], 0.0, "most things are not metal");
    assert!(copied("it.obj", &files, &[(0, all_maps())]).warnings.is_empty());
}
