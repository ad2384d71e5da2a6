//! Pictures of groups on their models and in their variants.

use std::path::Path;
use std::process::Stdio;

use super::FOLDER;
use super::group::LibraryGroup;
use crate::small_png::{RgbPicture, encode, read};
use xtask::project::{Project, TaskError, finish, not_written, write_file};

/// Size of a picture of one model or variant, and bytes that a strip of them may take.
const TILE: [usize; 2] = [320, 240];
const MOST_BYTES: usize = 72 * 1024;

/// Draws a group on its models, and its variants on the first of them.
pub(super) fn draw_group(
    project: &Project,
    groups: &[LibraryGroup],
    group: &LibraryGroup,
    work: &Path,
) -> Result<(), TaskError> {
    let [first, ..] = group.models();
    let on_models = group.models().map(|model| (None, model));
    strip(project, groups, group, work, &on_models, &group.stem)?;
    let variants: Vec<(Option<&str>, &str)> = group.variants().into_iter().map(|variant| (variant, first)).collect();
    strip(
        project,
        groups,
        group,
        work,
        &variants[1..],
        &format!("{}.variants", group.stem),
    )
}

/// Draws pictures side by side.
fn strip(
    project: &Project,
    groups: &[LibraryGroup],
    group: &LibraryGroup,
    work: &Path,
    shots: &[(Option<&str>, &str)],
    name: &str,
) -> Result<(), TaskError> {
    let mut tiles = Vec::new();
    for (number, (variant, model)) in shots.iter().enumerate() {
        let graph = work.join(format!("{name}_{number}.sabi"));
        write_file(&graph, group.shown(groups, *variant).to_string())?;
        let drawn = work.join(format!("{name}_{number}.png"));
        let mut render = project.command(&project.sabi("release"))?;
        let [width, height] = TILE;
        render
            .arg("render")
            .arg(&graph)
            .args(["--adapter", "cpu", "--quiet", "--samples", "16"])
            .args(["--size", &format!("{width}x{height}")])
            .args(["--mesh", &format!("assets/meshes/{model}.glb")])
            .arg("-o")
            .arg(&drawn)
            .stdout(Stdio::null());
        finish(render, &format!("Drawing {name}"))?;
        tiles.push(read(&drawn).map_err(|why| not_written(&drawn, &why))?);
    }
    let path = project.root.join(FOLDER).join(format!("{name}.png"));
    let size = [TILE[0] * tiles.len(), TILE[1]];
    let small = encode(&side_by_side(&tiles), size, MOST_BYTES).map_err(|why| not_written(&path, &why))?;
    write_file(&path, small)?;
    eprintln!("{}", path.display());
    Ok(())
}

/// Pixels of pictures of one size, from left to right.
fn side_by_side(tiles: &[RgbPicture]) -> Vec<[u8; 3]> {
    let [width, height] = TILE;
    let rows = (0..height).flat_map(|row| {
        tiles
            .iter()
            .map(move |tile| &tile.pixels[row * width..(row + 1) * width])
    });
    rows.flatten().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_group_has_its_pictures() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for group in crate::effects::group::groups(&root).expect("groups") {
            for name in [format!("{}.png", group.stem), format!("{}.variants.png", group.stem)] {
                assert!(root.join(FOLDER).join(&name).is_file(), "there is no {FOLDER}/{name}");
            }
        }
    }
}
