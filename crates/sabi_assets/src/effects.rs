//! `cargo xtask library`: the groups of the effect library on models, drawn by `sabi render`, with a page about each, and their
//! times.

mod group;
mod group_pictures;
mod page;
mod times;

use self::group::{GROUPS, groups};
use xtask::project::{Project, TaskError, create_folder, finish, write_file};
use xtask::vulkan::{self, Driver};

/// Folder of the pages and pictures, relative to the root.
const FOLDER: &str = "docs/library";
/// Argument that asks for times in place of pictures.
const TIMES: &str = "--times";
/// Categories in the order of the page, with their titles.
const CATEGORIES: [(&str, &str); 4] = [
    ("base", "Base materials"),
    ("generator", "Generators"),
    ("weathering", "Weathering"),
    ("finish", "Finish"),
];

/// Draws the pictures of all groups or of those named, and writes the page; or measures their times.
pub(crate) fn run(project: &Project, names: &[String]) -> Result<(), TaskError> {
    let measures = names.iter().any(|name| name == TIMES);
    let names: Vec<&String> = names.iter().filter(|name| *name != TIMES).collect();
    let groups = groups(&project.root)?;
    if let Some(unknown) = names
        .iter()
        .find(|name| groups.iter().all(|group| group.stem != ***name))
    {
        return Err(TaskError::new(2, format!("There is no group `{unknown}` in {GROUPS}.")));
    }
    vulkan::ensure(project, Driver::Software)?;
    // Without the editor, as for the demo: pictures and bakes need none of it.
    let build = "build --quiet --release --locked --package sabi --no-default-features";
    let build: Vec<&str> = build.split(' ').collect();
    finish(project.cargo(&build)?, "Building sabi")?;
    let work = project.target.join("library");
    for folder in [&work, &project.root.join(FOLDER)] {
        create_folder(folder)?;
    }
    if measures {
        let page = project.root.join(FOLDER).join("times.md");
        return times::measure(project, &groups, &work, &page);
    }
    for group in groups
        .iter()
        .filter(|group| names.is_empty() || names.contains(&&group.stem))
    {
        group_pictures::draw_group(project, &groups, group, &work)?;
    }
    write_file(&project.root.join(FOLDER).join("README.md"), page::page(&groups))
}
