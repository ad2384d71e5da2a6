//! Outputs of the graph and maps of the model itself.

use super::*;
use crate::MeshMap;

/// Names of the files of a set with one channel, under the default preset.
fn files_of(folder: &Path, channel: &Channel, value: impl Fn(usize) -> f32) -> Vec<String> {
    let outputs = bake_set(folder, &preset("raw"), &[(channel.clone(), pixels(channel, value))]);
    outputs.into_iter().map(|output| output.path).collect()
}

#[test]
fn a_color_output_is_a_file_in_srgb_and_one_in_floats_where_it_exceeds_one() {
    let folder = tempfile::tempdir().unwrap();
    let tint = Channel::Color("tint".into());
    let names = files_of(folder.path(), &tint, |at| if at % 6 < 3 { 0.5 } else { 0.25 });
    assert_eq!(names, ["wood_tint.png"]);
    let (channels, found) = codes(folder.path(), "wood_tint.png");
    let pixel = (10 * SIZE as usize + 10) * 3;
    assert_eq!(
        (channels, &found[pixel..pixel + 6]),
        (3, &[188, 188, 188, 137, 137, 137][..])
    );
    let names = files_of(folder.path(), &tint, |at| if at % 6 < 3 { 0.5 } else { 4.0 });
    assert_eq!(names, ["wood_tint.png", "wood_tint.exr"]);
    let exact = decode("t.exr", &fs::read(folder.path().join("wood_tint.exr")).unwrap()).unwrap();
    let Pixels::F32(values) = exact.pixels else {
        panic!("floats")
    };
    assert_eq!(values[pixel..pixel + 6], [0.5, 0.5, 0.5, 4.0, 4.0, 4.0]);
}

#[test]
fn a_vector_output_is_a_file_of_its_own_floats() {
    let folder = tempfile::tempdir().unwrap();
    let flow = Channel::Vector("flow".into());
    let value = |at: usize| at as f32 * 0.01 - 7.5;
    assert_eq!(files_of(folder.path(), &flow, value), ["wood_flow.exr"]);
    let exact = decode("f.exr", &fs::read(folder.path().join("wood_flow.exr")).unwrap()).unwrap();
    assert_eq!(
        (exact.channels, exact.pixels),
        (3, Pixels::F32(pixels(&flow, value).data))
    );
}

#[test]
fn maps_of_the_model_are_coded_by_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let [normal, bend] = [MeshMap::WorldNormal, MeshMap::Curvature].map(Channel::Mesh);
    // Downward and to the left; padding has no direction.
    let down = pixels(&normal, |at| match (at / 3 % 2, at % 3) {
        (0, 1) => -2.0,
        (1, 0) => -1.0,
        _ => 0.0,
    });
    let bends = pixels(&bend, |at| [-1.0, 0.0, 0.5][at % 3]);
    let outputs = bake_set(folder.path(), &preset("mesh"), &[(normal, down), (bend, bends)]);
    let told: Vec<(&str, &[String])> = outputs
        .iter()
        .map(|output| (output.path.as_str(), &output.components[..]))
        .collect();
    let letters = ["r", "g", "b"].map(|letter| format!("mesh(world_normal).{letter}"));
    assert_eq!(
        told,
        [
            ("wood_world_normal.png", &letters[..]),
            ("wood_curvature.png", &["mesh(curvature)".to_owned()][..])
        ]
    );
    let deep = |name: &str| match decode(name, &fs::read(folder.path().join(name)).unwrap())
        .unwrap()
        .pixels
    {
        Pixels::U16(codes) => codes,
        _ => panic!("16 bits"),
    };
    let pixel = 10 * SIZE as usize + 10;
    let found = deep("wood_world_normal.png");
    assert_eq!(found[pixel * 3..pixel * 3 + 6], [32768, 0, 32768, 0, 32768, 32768]);
    let start = pixel - pixel % 3;
    assert_eq!(deep("wood_curvature.png")[start..start + 3], [0, 32768, 49151]);
}
