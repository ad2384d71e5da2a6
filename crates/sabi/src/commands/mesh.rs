//! `sabi mesh`: a model and its atlas.

use sabi_engine::opening::linked_model::LinkedModel;
use sabi_engine::opening::mesh_report::{MeshReport, describe_mesh};
use sabi_engine::opening::overlap::{SetReport, SharedPairs};
use sabi_files::TrustedPaths;
use serde::Serialize;

use crate::arguments::MeshArguments;
use crate::exit::{Exit, Failure};
use crate::printable::Page;
use crate::progress::ShownProgress;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: MeshArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let options = arguments.model.options(arguments.mesh, trusted, arguments.maps.size);
    let progress = ShownProgress::new(terminal);
    let linked = LinkedModel::open(&options, &progress)?;
    drop(progress);
    let report = describe_mesh(&linked);
    terminal.warnings(&report.warnings);
    if arguments.json {
        terminal.json(&report)?;
    } else {
        terminal.page(&table(&report)?)?;
    }
    Ok(Exit::Done)
}

/// Returns a text with one fact per line; warnings were shown already.
fn table(report: &MeshReport) -> Result<Page, Failure> {
    let [page_width, page_height] = report.page_size;
    let facts = [
        ("triangles", report.triangles.to_string()),
        ("vertices", report.vertices.to_string()),
        ("parts", report.parts.join(", ")),
        ("parts left out", report.parts_left_out.join(", ")),
        ("pieces", report.pieces.to_string()),
        ("materials", report.materials.join(", ")),
        ("unwrapped", on_one_line(&report.unwrapped)?),
        ("decoded uvs", on_one_line(&report.decoded_uvs)?),
        ("smoothed", on_one_line(&report.smooth_degrees)?),
        ("turned faces", report.turned_faces.to_string()),
        ("faces inside out", report.inside_out_faces.to_string()),
        ("vertex colors", report.vertex_colors.to_string()),
        ("largest side", report.largest_side.to_string()),
        ("size", report.size.to_string()),
        ("pages", report.pages.to_string()),
        ("page size", format!("{page_width}, {page_height}")),
        ("charts", report.charts.to_string()),
        ("coverage", report.coverage.to_string()),
        ("texture sets", sets(report)),
        ("overlap", on_one_line(&report.overlap)?),
        ("overlapping charts", report.overlapping_charts.to_string()),
        ("stacked charts", report.stacked_charts.to_string()),
        ("mirrored charts", report.mirrored_charts.to_string()),
        ("moved charts", report.moved_charts.to_string()),
        ("thin charts", report.thin_charts.to_string()),
        ("degenerate triangles", report.degenerate_triangles.to_string()),
        ("degenerate uv triangles", report.degenerate_uv_triangles.to_string()),
        ("nonmanifold edges", report.nonmanifold_edges.to_string()),
        ("border edges", report.border_edges.to_string()),
        ("ghost texels", report.ghost_texels.to_string()),
        ("unlinked ghosts", report.unlinked_ghosts.to_string()),
    ];
    Ok(facts
        .into_iter()
        .map(|(name, value)| format!("{name:24} {value}"))
        .collect())
}

/// Texture sets, each with the number of its charts, their coverage, and the number of overlapping pairs.
fn sets(report: &MeshReport) -> String {
    let set = |set: &SetReport| {
        let tile = set.udim.map_or_else(String::new, |number| format!(".{number}"));
        let SharedPairs {
            stacked,
            mirrored,
            tiling,
            partial,
        } = set.overlap.pairs;
        let covered = (100.0 * set.coverage).round();
        let pairs = stacked + mirrored + tiling + partial;
        format!(
            "{}{tile} (charts {}, covered {covered} %, overlapping pairs {pairs})",
            set.material, set.charts
        )
    };
    report.sets.iter().map(set).collect::<Vec<_>>().join(", ")
}

fn on_one_line(facts: &impl Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string(facts);
    text.map_err(|error| Failure::new(Exit::Defect, format!("cannot write the model's facts: {error}")))
}
