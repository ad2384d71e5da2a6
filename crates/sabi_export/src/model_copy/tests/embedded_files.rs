//! Copies that hold their pictures and buffers.

use super::*;

const EMBEDDED: CopyOptions = CopyOptions {
    keeps_look: false,
    embeds: true,
};

/// The copy, alone in a folder, read back; its document.
fn alone(finished: &FinishedCopy) -> (Model, Json) {
    assert!(finished.warnings.is_empty(), "{:?}", finished.warnings);
    assert!(finished.beside.is_empty(), "{:?}", finished.beside);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(&finished.copy.name);
    fs::write(&path, &finished.copy.bytes).unwrap();
    let model = load(&path, &LoadOptions::default()).unwrap();
    (model, Container::split(&finished.copy.bytes).unwrap().1)
}

/// The pictures that the copy is to show: those of glass, which was not baked, and the maps of cloth.
fn assert_shows(what: &str, model: &Model, glass: &str) {
    let shown = |material: usize| {
        let texture = model.materials[material].base_color.as_ref().unwrap();
        model.images[texture.image].bytes.clone().unwrap().to_vec()
    };
    assert_eq!([shown(0), shown(1)], [picture(glass), picture("new color")], "{what}");
    let normal = model.materials[1].normal.as_ref().unwrap();
    assert_eq!(
        model.images[normal.image].bytes.clone().unwrap().to_vec(),
        picture("new normal"),
        "{what}"
    );
}

#[test]
fn a_gltf_copy_holds_everything_as_data_uris() {
    let (mut document, binary) = document();
    document["buffers"][0]["uri"] = json!("data/geo%20metry.bin");
    document["images"][3] = json!({ "uri": "glass pane.png" });
    document["images"][2] = json!({ "uri": "data:image/png;base64,iVBORw==" });
    let text = document.to_string();
    let pane = picture("pane");
    let files: [(&str, &[u8]); 3] = [
        ("it.gltf", text.as_bytes()),
        ("geo metry.bin", &binary),
        ("glass pane.png", &pane),
    ];
    let finished = copied_with(EMBEDDED, "it.gltf", &files, &[(1, all_maps())]);
    let (model, is) = alone(&finished);
    assert_shows("glTF", &model, "pane");
    assert_eq!(is["images"][2], document["images"][2]);
    // The second buffer has the tangents.
    for buffer in 0..2 {
        let uri = is["buffers"][buffer]["uri"].as_str().unwrap();
        assert!(uri.starts_with("data:application/octet-stream;base64,"), "{uri}");
    }
    assert!(
        is["images"][3]["uri"]
            .as_str()
            .unwrap()
            .starts_with("data:image/png;base64,")
    );
}

#[test]
fn a_glb_copy_holds_everything_in_its_chunk() {
    let (mut document, binary) = document();
    let pane = picture("pane");
    for image in [3, 2] {
        document["images"][image] = json!({ "uri": "pane.png" });
    }
    let in_chunk = glb_of(&document, &binary);
    document["buffers"][0]["uri"] = json!("it.bin");
    let beside = glb_of(&document, &[]);
    for (what, file) in [("chunk", &in_chunk), ("first buffer in a file", &beside)] {
        let files: [(&str, &[u8]); 3] = [("it.glb", file), ("it.bin", &binary), ("pane.png", &pane)];
        let finished = copied_with(EMBEDDED, "it.glb", &files, &[(1, all_maps())]);
        let (model, is) = alone(&finished);
        assert_shows(what, &model, "pane");
        assert!(!is.to_string().contains("\"uri\""), "{what}: {is}");
        let pane = &is["images"][3];
        assert_eq!(pane["mimeType"], "image/png");
        assert_eq!(
            pane["bufferView"], is["images"][2]["bufferView"],
            "{what}: it is there once"
        );
    }
}

/// A GLB file, without a chunk where that is empty.
fn glb_of(document: &Json, binary: &[u8]) -> Vec<u8> {
    let file = super::super::container::tests::glb(document, binary);
    let mut file = if binary.is_empty() {
        file[..file.len() - 8].to_vec()
    } else {
        file
    };
    let size = file.len() as u32;
    file[8..12].copy_from_slice(&size.to_le_bytes());
    file
}

#[test]
fn a_file_that_is_not_embedded_is_reported() {
    let (mut document, binary) = document();
    document["images"][3] = json!({ "uri": "gone.png" });
    let file = super::super::container::tests::glb(&document, &binary);
    let finished = copied_with(EMBEDDED, "it.glb", &[("it.glb", &file)], &[(1, all_maps())]);
    let sentence = "the copy of the model names gone.png as the model does, but it was not copied: ";
    assert_eq!(finished.warnings.len(), 1);
    assert!(finished.warnings[0].starts_with(sentence), "{:?}", finished.warnings);
}
