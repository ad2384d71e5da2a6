//! `cargo xtask pictures`: the example graphs on models, drawn by `sabi render` for the README and the docs.

use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::process::Stdio;

use crate::place::{Place, Stop, finish};
use crate::small_png::encode;
use crate::vulkan::{self, Driver};

/// Where the pictures are, from the root.
const FOLDER: &str = "docs/pictures";

/// One graph as it is shown on several models.
struct Example {
    graph: &'static str,
    /// Models, and for each where the eye is.
    models: [(&'static str, &'static str); 3],
    environment: &'static str,
}

/// Every example graph on three models.
const EXAMPLES: [Example; 9] = [
    Example {
        graph: "weathered-bench",
        models: [
            ("bench", "-35,18,0.8"),
            ("chair", "-30,15,0.95"),
            ("table", "30,18,0.95"),
        ],
        environment: "overcast",
    },
    Example {
        graph: "mossy-figure",
        models: [("figure", "-25,10,0.85"), ("column", "-25,8,1"), ("wall", "30,12,0.9")],
        environment: "overcast",
    },
    Example {
        graph: "rusty-metal",
        models: [("barrel", "25,20,0.85"), ("chain", "30,20,1"), ("figure", "25,10,0.85")],
        environment: "studio",
    },
    Example {
        graph: "old-stone",
        models: [("column", "-25,8,1"), ("wall", "30,12,0.9"), ("figure", "25,10,0.85")],
        environment: "low_sun",
    },
    Example {
        graph: "varnished-wood",
        models: [
            ("chair", "-30,15,0.95"),
            ("table", "30,18,0.95"),
            ("barrel", "25,20,0.85"),
        ],
        environment: "studio",
    },
    Example {
        graph: "weathered-paint",
        models: [
            ("crate", "-35,22,0.85"),
            ("barrel", "25,20,0.85"),
            ("figure", "25,10,0.85"),
        ],
        environment: "studio",
    },
    Example {
        graph: "thesis/occlusion-in-the-color",
        models: [
            ("figure", "25,10,0.85"),
            ("crate", "-35,22,0.85"),
            ("chair", "-30,15,0.95"),
        ],
        environment: "overcast",
    },
    Example {
        graph: "thesis/stone-bench",
        models: [("bench", "-35,18,0.8"), ("column", "-25,8,1"), ("figure", "25,10,0.85")],
        environment: "low_sun",
    },
    Example {
        graph: "thesis/rusty-edges",
        models: [
            ("crate", "-35,22,0.85"),
            ("barrel", "25,20,0.85"),
            ("figure", "25,10,0.85"),
        ],
        environment: "studio",
    },
];

/// Pixels of a picture, and the bytes that it may take.
const SIZE: [usize; 2] = [400, 300];
const MOST_BYTES: usize = 48 * 1024;

/// The picture at the head of the README, and what draws it.
const HEAD: &str = "head";
const HEAD_SIZE: [usize; 2] = [1280, 640];
const HEAD_BYTES: usize = 320 * 1024;
const HEAD_SCENE: [&str; 18] = [
    "graphs/weathered-bench.sabi",
    "--mesh",
    "assets/meshes/bench.glb",
    "--texels",
    "2048",
    "--environment",
    "studio",
    "--camera",
    "-32,12,0.8",
    "--light",
    "-50,40,2",
    "--transform",
    "aces",
    "--exposure",
    "0.3",
    "--relief",
    "--background",
    // Few colors would show bands in a soft one.
    "plain",
];

/// Draws all pictures, or those of the named graphs.
pub(crate) fn run(place: &Place, names: &[String]) -> Result<(), Stop> {
    let known = || EXAMPLES.iter().map(|example| example.graph).chain([HEAD]);
    if let Some(unknown) = names.iter().find(|name| !known().any(|known| known == *name)) {
        let all = known().collect::<Vec<_>>().join(", ");
        return Err(Stop::new(
            2,
            format!("There is no example `{unknown}`. These exist: {all}."),
        ));
    }
    vulkan::ensure(place, Driver::Software)?;
    finish(
        place.cargo(&["build", "--quiet", "--release", "--locked", "--package", "sabi"])?,
        "Building sabi",
    )?;
    let desk = place.target.join("pictures");
    for folder in [&desk, &place.root.join(FOLDER)] {
        fs::create_dir_all(folder)
            .map_err(|error| Stop::new(1, format!("The folder {} cannot be made: {error}.", folder.display())))?;
    }
    let is_asked = |name: &str| names.is_empty() || names.iter().any(|asked| asked == name);
    for example in EXAMPLES.iter().filter(|example| is_asked(example.graph)) {
        for (model, camera) in example.models {
            let (graph, mesh) = (
                format!("graphs/{}.sabi", example.graph),
                format!("assets/meshes/{model}.glb"),
            );
            let scene = [
                graph.as_str(),
                "--mesh",
                &mesh,
                "--environment",
                example.environment,
                "--camera",
                camera,
                "--texels",
                "2048",
                "--background",
                "blurred",
            ];
            let name = file_name(example.graph, model);
            draw(place, &desk, &scene, &name, SIZE, MOST_BYTES)?;
        }
    }
    if is_asked(HEAD) {
        draw(place, &desk, &HEAD_SCENE, "head.png", HEAD_SIZE, HEAD_BYTES)?;
    }
    let path = place.root.join(FOLDER).join("README.md");
    fs::write(&path, page()).map_err(|error| Stop::new(1, format!("{} cannot be written: {error}.", path.display())))
}

/// All pictures on a page, a row for each graph.
fn page() -> String {
    let row = |example: &Example| {
        let graph = example.graph;
        let pictures = example.models.map(|(model, _)| {
            let file = file_name(graph, model);
            format!(" ![{graph} on a {model}]({file}) |")
        });
        format!("| [{graph}](../../graphs/{graph}.sabi) |{}\n", pictures.concat())
    };
    let rows: String = EXAMPLES.iter().map(row).collect();
    format!(
        "# The example graphs on three models each\n\nWritten by `cargo xtask pictures`; the same parameters on every model.\n\n\
         | graph | | | |\n|---|---|---|---|\n{rows}"
    )
}

/// What a picture is called.
fn file_name(graph: &str, model: &str) -> String {
    let stem = graph.rsplit('/').next().unwrap_or(graph);
    format!("{stem}-{model}.png")
}

/// Draws one picture and keeps it with few colors.
fn draw(
    place: &Place,
    desk: &Path,
    scene: &[&str],
    name: &str,
    size: [usize; 2],
    most_bytes: usize,
) -> Result<(), Stop> {
    let drawn = desk.join(name);
    let sabi = place
        .target
        .join("release")
        .join(format!("sabi{}", std::env::consts::EXE_SUFFIX));
    let [width, height] = size;
    let mut render = place.command(&sabi)?;
    // The software driver, so that everybody draws the same bytes.
    render
        .args([
            "render",
            "--adapter",
            "cpu",
            "--quiet",
            "--samples",
            "32",
            "--size",
            &format!("{width}x{height}"),
        ])
        .args(scene)
        .arg("-o")
        .arg(&drawn)
        .stdout(Stdio::null());
    finish(render, &format!("Drawing {name}"))?;
    let path = place.root.join(FOLDER).join(name);
    let small = pixels_of(&drawn).and_then(|pixels| encode(&pixels, size, most_bytes));
    let written = small.and_then(|bytes| fs::write(&path, bytes).map_err(|error| error.to_string()));
    written.map_err(|why| Stop::new(1, format!("{} cannot be written: {why}.", path.display())))?;
    eprintln!("{}", path.display());
    Ok(())
}

/// The pixels of a PNG of 8 bits and three channels, as `sabi render` writes it.
fn pixels_of(path: &Path) -> Result<Vec<[u8; 3]>, String> {
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    let mut reader = png::Decoder::new(Cursor::new(bytes))
        .read_info()
        .map_err(|error| error.to_string())?;
    let size = reader
        .output_buffer_size()
        .ok_or("the picture does not fit into memory")?;
    let mut codes = vec![0; size];
    reader.next_frame(&mut codes).map_err(|error| error.to_string())?;
    let (pixels, _) = codes.as_chunks::<3>();
    Ok(pixels.to_vec())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_example_graph_is_shown_on_models_of_its_own_project() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut names = BTreeSet::new();
        for example in &EXAMPLES {
            assert!(root.join(format!("graphs/{}.sabi", example.graph)).is_file());
            for (model, _) in example.models {
                assert!(root.join(format!("assets/meshes/{model}.glb")).is_file());
                assert!(names.insert(file_name(example.graph, model)));
            }
        }
        for folder in ["graphs", "graphs/thesis"] {
            for file in fs::read_dir(root.join(folder)).unwrap() {
                let path = file.unwrap().path();
                if path.extension().is_some_and(|ending| ending == "sabi") {
                    let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
                    let is_shown = EXAMPLES.iter().any(|example| example.graph.ends_with(&stem));
                    assert!(is_shown, "{stem} has no pictures");
                }
            }
        }
    }
}
