use super::*;

/// A GLB file of just this document and binary chunk.
pub(in crate::model_copy) fn glb(document: &Json, binary: &[u8]) -> Vec<u8> {
    let mut file = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    chunk(&mut file, JSON_CHUNK, document.to_string().into_bytes(), b' ').unwrap();
    chunk(&mut file, BINARY_CHUNK, binary.to_vec(), 0).unwrap();
    let size = length(file.len() as u64).unwrap();
    file[8..12].copy_from_slice(&size);
    file
}

/// One with only a first buffer.
fn with_buffer(buffer: Json, binary: &[u8]) -> Vec<u8> {
    glb(&json!({ "asset": { "version": "2.0" }, "buffers": [buffer] }), binary)
}

#[test]
fn only_padding_zeros_of_the_chunk_are_dropped() {
    let data = [1, 2, 3, 4, 5, 6, 7, 0, 0, 0, 0, 0];
    let cases = [
        ("right", json!(12), 12),
        ("up to three zeros of filler", json!(9), 9),
        ("more than filler", json!(8), 12),
        ("far too small", json!(0), 12),
        ("too large", json!(99), 12),
        ("none", json!(null), 12),
    ];
    for (case, claimed, expected) in cases {
        let (container, _) = Container::split(&with_buffer(json!({ "byteLength": claimed }), &data)).unwrap();
        assert_eq!(container.binary(), &data[..expected], "{case}");
    }
    let (container, _) = Container::split(&with_buffer(json!({ "byteLength": 6 }), &data[..8])).unwrap();
    assert_eq!(container.binary(), &data[..8], "what is not zero is no filler");
}

#[test]
fn a_chunk_that_is_not_a_buffer_is_kept_and_gets_no_new_data() {
    for buffer in [json!({ "byteLength": 4, "uri": "a.bin" }), json!(null)] {
        let file = with_buffer(buffer, &[1, 2, 3, 4]);
        let (mut container, mut document) = Container::split(&file).unwrap();
        assert_eq!(container.put(&[9; 4]), None);
        container.forget(&mut document, &[json!({ "buffer": 0, "byteLength": 4 })]);
        assert_eq!(container.join(&mut document).unwrap(), file);
    }
}

#[test]
fn sizes_that_do_not_fit_into_32_bits_are_refused() {
    assert_eq!(length(u64::from(u32::MAX)), Ok([0xff; 4]));
    assert_eq!(length(1 << 32), Err(1 << 32));
}

#[test]
fn cuts_move_every_later_view_by_the_bytes_removed_before_it() {
    // Views of 40 bytes, filled with the number of the view. Every other one is dead, and a live one extends into the last of these.
    let view = |from: usize, size: usize| json!({ "buffer": 0, "byteOffset": from, "byteLength": size });
    let binary: Vec<u8> = (0..400_u32).map(|at| (at / 40) as u8).collect();
    let mut live: Vec<Json> = (0..5).map(|pair| view(pair * 80, 40)).collect();
    live.push(view(390, 2));
    let dead: Vec<Json> = (0..5).rev().map(|pair| view(pair * 80 + 40, 40)).collect();
    let mut document = json!({ "bufferViews": live });
    let mut container = Container::glb(binary);
    container.forget(&mut document, &dead);
    // Cuts are whole multiples of 16: 32 of 40 bytes each.
    assert_eq!(container.binary().len(), 400 - 4 * 32);
    let offsets = |document: &Json| -> Vec<u64> {
        let views = document["bufferViews"].as_array().unwrap().iter();
        views.map(|view| view["byteOffset"].as_u64().unwrap()).collect()
    };
    assert_eq!(offsets(&document), [0, 48, 96, 144, 192, 262]);
    for (number, start) in [0, 48, 96, 144, 192].into_iter().enumerate() {
        assert_eq!(container.binary()[start..start + 40], [2 * number as u8; 40]);
    }
    assert_eq!(container.binary()[262], 9);
}
