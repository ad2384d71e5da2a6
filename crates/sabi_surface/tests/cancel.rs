//! Canceled work on models ends, wherever it is.

use std::path::Path;
use std::thread;

use sabi_cancel::{Cancel, CanceledWork, cancelable};
use sabi_surface::atlas::{Atlas, AtlasOptions};
use sabi_surface::load::{LoadOptions, load_bytes};
use sabi_surface::model::Model;
use sabi_surface::pieces::Pieces;
use sabi_surface::unwrap::unwrap_cached;

/// Rows and columns of the squares of a sheet: more triangles than there are between two looks.
const SIDE: u32 = 40;

fn corners() -> impl Iterator<Item = [u32; 3]> {
    let row = SIDE + 1;
    (0..SIDE * SIDE).flat_map(move |cell| {
        let first = cell / SIDE * row + cell % SIDE;
        [
            [first, first + 1, first + row],
            [first + 1, first + row + 1, first + row],
        ]
    })
}

fn places() -> impl Iterator<Item = [u32; 2]> {
    (0..(SIDE + 1).pow(2)).map(|n| [n % (SIDE + 1), n / (SIDE + 1)])
}

fn obj() -> Vec<u8> {
    let share = |n: u32| f64::from(n) / f64::from(SIDE);
    let vertices = places().map(|[x, y]| format!("v {x} {y} 0\nvt {} {}\n", share(x), share(y)));
    let faces = corners().map(|face| {
        let [a, b, c] = face.map(|corner| corner + 1);
        format!("f {a}/{a} {b}/{b} {c}/{c}\n")
    });
    let text: String = std::iter::once("mtllib it.mtl\nusemtl it\n".to_owned())
        .chain(vertices)
        .chain(faces)
        .collect();
    text.into_bytes()
}

fn ply() -> Vec<u8> {
    let (vertices, faces) = (places().count(), corners().count());
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\nelement face \
         {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    text.extend(places().map(|[x, y]| format!("{x} {y} 0\n")));
    text.extend(corners().map(|[a, b, c]| format!("3 {a} {b} {c}\n")));
    text.into_bytes()
}

fn stl() -> Vec<u8> {
    let places: Vec<[u32; 2]> = places().collect();
    let mut bytes = vec![0; 80];
    bytes.extend((corners().count() as u32).to_le_bytes());
    for face in corners() {
        bytes.extend([0; 12]);
        for [x, y] in face.map(|corner| places[corner as usize]) {
            bytes.extend([x as f32, y as f32, 0.0].into_iter().flat_map(f32::to_le_bytes));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn dae() -> Vec<u8> {
    let list = |values: Vec<String>| values.join(" ");
    let positions = list(places().map(|[x, y]| format!("{x} {y} 0")).collect());
    let indices = list(corners().map(|[a, b, c]| format!("{a} {b} {c}")).collect());
    format!(
        r##"<COLLADA version="1.4.1"><library_geometries><geometry id="g"><mesh>
        <source id="p"><float_array id="f">{positions}</float_array>
        <technique_common><accessor source="#f" stride="3"/></technique_common></source>
        <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
        <triangles><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles></mesh></geometry>
        </library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
        </library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"##
    )
    .into_bytes()
}

fn glb() -> Vec<u8> {
    let asset = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes/sphere.glb");
    std::fs::read(asset).expect("an asset")
}

fn read(name: &str, bytes: &[u8]) -> Model {
    let mut resolve = |_: &str| Ok(b"newmtl it\nKd 1 0 0\n".to_vec());
    load_bytes(name, bytes, &mut resolve, &LoadOptions::default()).expect("a model")
}

/// Runs work that is canceled before it begins.
fn at_once(work: impl FnOnce()) -> Result<(), CanceledWork> {
    let request = Cancel::new();
    request.cancel();
    cancelable(&request, work)
}

#[test]
fn readers_of_all_formats_hear_a_cancelation() {
    for (name, bytes) in [
        ("it.obj", obj()),
        ("it.ply", ply()),
        ("it.stl", stl()),
        ("it.dae", dae()),
        ("it.glb", glb()),
    ] {
        assert!(!read(name, &bytes).mesh.triangles.is_empty(), "{name}");
        assert_eq!(at_once(|| drop(read(name, &bytes))), Err(CanceledWork), "{name}");
    }
}

#[test]
fn a_cancelation_is_heard_after_the_last_file_beside_a_model_was_read() {
    let request = Cancel::new();
    let bytes = obj();
    let read = cancelable(&request, || {
        let mut resolve = |_: &str| {
            request.cancel();
            Err("it is gone".to_owned())
        };
        load_bytes("it.obj", &bytes, &mut resolve, &LoadOptions::default()).map(drop)
    });
    assert_eq!(read, Err(CanceledWork));
}

#[test]
fn every_step_after_the_reading_hears_a_cancelation() {
    let model = read("it.obj", &obj());
    let bare = read("it.stl", &stl());
    let size = AtlasOptions::new(256);
    assert_eq!(at_once(|| drop(Atlas::build(&model.mesh, &size))), Err(CanceledWork));
    assert_eq!(at_once(|| drop(unwrap_cached(None, &bare.mesh))), Err(CanceledWork));
    assert_eq!(at_once(|| drop(Pieces::of(&model.mesh))), Err(CanceledWork));
}

#[test]
fn work_that_is_canceled_at_any_moment_ends_canceled_or_whole() {
    let model = read("it.obj", &obj());
    let whole = Atlas::build(&model.mesh, &AtlasOptions::new(256)).unwrap();
    for spins in (0..24).map(|power| 1_u64 << power) {
        let request = Cancel::new();
        let asking = request.clone();
        let asks = thread::spawn(move || {
            (0..spins).for_each(|_| std::hint::spin_loop());
            asking.cancel();
        });
        let built = cancelable(&request, || Atlas::build(&model.mesh, &AtlasOptions::new(256)).unwrap());
        asks.join().unwrap();
        assert!(
            built == Err(CanceledWork) || built.as_ref() == Ok(&whole),
            "after {spins} turns"
        );
    }
}
