//! `cargo xtask pictures`: the example graphs on models, drawn by `sabi render` for the README and the docs.

use std::path::Path;
use std::process::Stdio;

use crate::project::{Project, TaskError, create_folder, finish, not_written, write_file};
use crate::small_png::{encode, read};
use crate::vulkan::{self, Driver};

/// Folder of the pictures, relative to the root.
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
pub(crate) fn run(project: &Project, names: &[String]) -> Result<(), TaskError> {
    let known = || EXAMPLES.iter().map(|example| example.graph).chain([HEAD]);
    if let Some(unknown) = names.iter().find(|name| !known().any(|known| known == *name)) {
        let all = known().collect::<Vec<_>>().join(", ");
        return Err(TaskError::new(
            2,
            format!("There is no example `{unknown}`. These exist: {all}."),
        ));
    }
    vulkan::ensure(project, Driver::Software)?;
    finish(
        project.cargo(&["build", "--quiet", "--release", "--locked", "--package", "sabi"])?,
        "Building sabi",
    )?;
    let work_folder = project.target.join("pictures");
    for folder in [&work_folder, &project.root.join(FOLDER)] {
        create_folder(folder)?;
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
            draw(project, &work_folder, &scene, &name, SIZE, MOST_BYTES)?;
        }
    }
    if is_asked(HEAD) {
        draw(project, &work_folder, &HEAD_SCENE, "head.png", HEAD_SIZE, HEAD_BYTES)?;
    }
    let path = project.root.join(FOLDER).join("README.md");
    write_file(&path, page())
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

/// Returns the file name of a picture.
fn file_name(graph: &str, model: &str) -> String {
    let stem = graph.rsplit('/').next().unwrap_or(graph);
    format!("{stem}-{model}.png")
}

/// Draws one picture and keeps it with few colors.
fn draw(
    project: &Project,
    work_folder: &Path,
    scene: &[&str],
    name: &str,
    size: [usize; 2],
    most_bytes: usize,
) -> Result<(), TaskError> {
    let drawn = work_folder.join(name);
    let sabi = project.sabi("release");
    let [width, height] = size;
    let mut render = project.command(&sabi)?;
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
    let path = project.root.join(FOLDER).join(name);
    let small = read(&drawn).and_then(|picture| encode(&picture.pixels, size, most_bytes));
    let small = small.map_err(|why| not_written(&path, &why))?;
    write_file(&path, small)?;
    eprintln!("{}", path.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;

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
