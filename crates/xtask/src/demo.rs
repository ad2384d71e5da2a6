//! `cargo xtask demo`: from a fresh clone to a baked texture set and a picture, with a summary of what came out.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use serde_json::Value;

use crate::place::{Place, Stop, finish};
use crate::vulkan::{self, Driver};

const GRAPH: &str = "graphs/weathered-bench.sabi";
const MODEL: &str = "assets/meshes/bench.glb";
const FOLDER: &str = "out/weathered-bench";
const REPORT: &str = "out/weathered-bench/report.json";
const PICTURE: &str = "out/weathered-bench.png";

/// Sets up, builds, bakes, draws and sums up.
pub(crate) fn run(place: &Place) -> Result<(), Stop> {
    vulkan::ensure(place, Driver::Any)?;
    eprintln!("Building sabi in release; the first time takes some minutes.");
    // Without the editor, most of what there is to compile is left out; the demo only bakes and draws.
    let build = [
        "build",
        "--release",
        "--locked",
        "--package",
        "sabi",
        "--no-default-features",
    ];
    finish(place.cargo(&build)?, "Building sabi")?;
    let sabi = place
        .target
        .join("release")
        .join(format!("sabi{}", std::env::consts::EXE_SUFFIX));
    let arguments = [
        "bake", GRAPH, "--mesh", MODEL, "--size", "2048", "-o", FOLDER, "--report", REPORT, "--quiet",
    ];
    eprintln!("$ sabi {}", arguments.join(" "));
    let mut bake = place.command(&sabi)?;
    // What it would say and list is in the summary.
    bake.args(arguments).stdout(Stdio::null());
    finish(bake, "The bake")?;
    let text = fs::read_to_string(place.root.join(REPORT))
        .map_err(|error| Stop::new(1, format!("The bake's report {REPORT} cannot be read: {error}.")))?;
    let report: Value = serde_json::from_str(&text)
        .map_err(|error| Stop::new(1, format!("The bake's report {REPORT} is not JSON: {error}.")))?;
    eprint!("\n{}", summary(&report, |path| size_of(&place.root, path)));
    let arguments = [
        "render",
        GRAPH,
        "--mesh",
        MODEL,
        "--texels",
        "2048",
        "--size",
        "1920x1080",
        "--environment",
        "low_sun",
        "--camera",
        "-35,18,0.9",
        "-o",
        PICTURE,
        "--quiet",
    ];
    eprintln!("$ sabi {}", arguments.join(" "));
    let mut render = place.command(&sabi)?;
    render.args(arguments).stdout(Stdio::null());
    finish(render, "The picture")?;
    eprintln!("\nThe bench in the evening sun: {PICTURE}");
    eprintln!("To work on it in the editor: cargo run --release --package sabi -- {GRAPH}");
    Ok(())
}

/// Bytes of an output; its path counts from the root, where the bake ran, or from the texture set's folder.
fn size_of(root: &Path, path: &str) -> Option<u64> {
    let places = [root.join(path), root.join(FOLDER).join(path)];
    places
        .iter()
        .find_map(|file| fs::metadata(file).ok())
        .map(|metadata| metadata.len())
}

fn counted(count: &Value, one: &str, many: &str) -> String {
    format!("{count} {}", if count.as_u64() == Some(1) { one } else { many })
}

/// The report in a few lines.
fn summary(report: &Value, bytes_of: impl Fn(&str) -> Option<u64>) -> String {
    let text = |value: &Value| value.as_str().unwrap_or("?").to_owned();
    let mut lines = vec![format!(
        "Baked {} in {} onto {}, {} texels square, on {} ({}).",
        counted(&report["nodes"], "node", "nodes"),
        counted(&report["passes"], "pass", "passes"),
        counted(&report["mesh"]["triangles"], "triangle", "triangles"),
        report["size"],
        text(&report["adapter"]["name"]),
        text(&report["adapter"]["kind"]),
    )];
    lines.push(format!("\nWritten into {FOLDER}:"));
    for output in report["outputs"].as_array().into_iter().flatten() {
        let path = text(&output["path"]);
        let name = Path::new(&path)
            .file_name()
            .map_or(path.clone(), |name| name.to_string_lossy().into_owned());
        let size = bytes_of(&path).map_or("?".into(), |bytes| format!("{} KiB", bytes.div_ceil(1024)));
        lines.push(format!(
            "  {name:<32} {:<12} {:>5}x{:<5} {:>2} bit {:<8} {size:>10}",
            text(&output["channel"]),
            output["width"].to_string(),
            output["height"].to_string(),
            output["bits"].to_string(),
            text(&output["color_space"]),
        ));
    }
    lines.push("\nTime of each stage:".into());
    let mut total = 0.0;
    for (stage, milliseconds) in report["stages_ms"].as_object().into_iter().flatten() {
        let milliseconds = milliseconds.as_f64().unwrap_or(0.0);
        total += milliseconds;
        lines.push(format!("  {stage:<10} {milliseconds:>9.1} ms"));
    }
    lines.push(format!("  {:<10} {total:>9.1} ms", "together"));
    for warning in report["warnings"].as_array().into_iter().flatten() {
        lines.push(format!("Warning: {}", text(warning)));
    }
    lines.push(format!("\nEverything about this bake: {REPORT}\n"));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn one_of_a_thing_is_not_many() {
        let report = json!({ "mesh": { "triangles": 1 }, "size": 64, "nodes": 1, "passes": 1 });
        let summary = summary(&report, |_| None);
        assert!(
            summary.starts_with("Baked 1 node in 1 pass onto 1 triangle, 64 texels square"),
            "{summary}"
        );
    }

    #[test]
    fn the_summary_says_what_was_written_where_and_how_long_each_stage_took() {
        let report = json!({
            "mesh": { "triangles": 8000 }, "adapter": { "name": "llvmpipe", "kind": "cpu" }, "size": 2048,
            "nodes": 14, "passes": 5, "stages_ms": { "load": 1.25, "run": 2000.0 }, "warnings": ["Two charts overlap."],
            "outputs": [{ "path": "out/weathered-bench/bench_base_color.png", "channel": "base_color", "width": 2048,
                "height": 2048, "bits": 8, "color_space": "srgb" }],
        });
        assert_eq!(
            summary(&report, |_| Some(3000)),
            "\
Baked 14 nodes in 5 passes onto 8000 triangles, 2048 texels square, on llvmpipe (cpu).

Written into out/weathered-bench:
  bench_base_color.png             base_color    2048x2048   8 bit srgb          3 KiB

Time of each stage:
  load             1.2 ms
  run           2000.0 ms
  together      2001.2 ms
Warning: Two charts overlap.

Everything about this bake: out/weathered-bench/report.json
"
        );
    }
}
