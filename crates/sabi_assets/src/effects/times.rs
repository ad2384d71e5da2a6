//! Times in which the groups of the effect library are baked without a GPU.

use std::fmt::Write;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use super::group::LibraryGroup;
use xtask::project::{Project, TaskError, create_folder, finish, write_file};

/// Model that is baked: the largest of the program's own.
const MODEL: &str = "assets/meshes/figure.glb";
/// Texels along a side of the maps.
const SIZE: &str = "2048";

/// Bakes each group over its base, and the base alone, and writes the table of times.
pub(super) fn measure(project: &Project, groups: &[LibraryGroup], work: &Path, page: &Path) -> Result<(), TaskError> {
    let mut text = format!(
        "# Times of the effect library\n\nWritten by `cargo xtask library --times`. Each group is baked once over its base material with \
         `sabi bake --size {SIZE} --adapter cpu` on the [figure](../../{MODEL}): from the start of the program to all maps on \
         disk, with an empty cache, so that the charts of the model are linked and the rays of masks are found in that time. Measured \
         with {} threads of a processor and no GPU; other machines differ.\n\n\
         | Group | Category | Seconds |\n|---|---|---|\n",
        std::thread::available_parallelism().map_or(1, usize::from)
    );
    let mut all = Vec::new();
    for group in groups {
        // A cache of its own, so that nothing is known of rays.
        let cache = work.join("cache");
        if cache.exists() {
            std::fs::remove_dir_all(&cache)
                .map_err(|error| TaskError::new(1, format!("{}: {error}", cache.display())))?;
        }
        let took = bake(project, groups, group, work, &cache)?.as_secs_f64();
        eprintln!("{:24} {took:6.1} s", group.stem);
        let (name, category) = (group.text("name"), &group.category);
        let _ = writeln!(text, "| {name} | {category} | {took:.1} |"); // Writing to a string does not fail.
        all.push(took);
    }
    all.sort_by(f64::total_cmp);
    if let (Some(middle), Some(longest)) = (all.get(all.len() / 2), all.last()) {
        let _ = writeln!(
            text,
            "\nThe middle one takes {middle:.1} s, the longest {longest:.1} s."
        );
    }
    write_file(page, text)
}

fn bake(
    project: &Project,
    groups: &[LibraryGroup],
    group: &LibraryGroup,
    work: &Path,
    cache: &Path,
) -> Result<Duration, TaskError> {
    let graph = work.join(format!("{}_times.sabi", group.stem));
    write_file(&graph, group.shown(groups, None).to_string())?;
    let maps = work.join("maps");
    create_folder(&maps)?;
    let mut bake = project.command(&project.sabi("release"))?;
    bake.env("SABI_CACHE_DIR", cache)
        .arg("bake")
        .arg(&graph)
        .args([
            "--adapter",
            "cpu",
            "--quiet",
            "--force",
            "--size",
            SIZE,
            "--mesh",
            MODEL,
        ])
        .arg("-o")
        .arg(&maps)
        .stdout(Stdio::null());
    let started = Instant::now();
    finish(bake, &format!("Baking {}", group.stem))?;
    Ok(started.elapsed())
}
