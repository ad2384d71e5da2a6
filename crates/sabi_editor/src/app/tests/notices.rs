//! Errors that are shown until the user closes them, badges of warnings, missing files that are found again, and models
//! whose reading is canceled.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use egui::Key;
use egui_kittest::kittest::Queryable;
use sabi_engine::Session;

use super::safety::CLOUDS;
use super::{Window, beside, graph_text};
use crate::action::ExportAction;
use crate::dock::Panel;
use crate::files::examples;
use crate::notices::Work;

/// Two triangles that share all of their UVs.
const STACKED: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n\
    vt 0.1 0.1\nvt 0.9 0.1\nvt 0.1 0.9\nf 1/1 2/2 3/3\nf 4/1 5/2 6/3\n";

impl Window {
    fn has_failure(&self, part: &str) -> bool {
        self.editor().shell.notices.has(part)
    }

    fn click_label(&mut self, label: &str) {
        let at = self.harness.get_by_label(label).rect().center();
        self.click_at(at);
    }

    /// Writes a model of this text, and shows it.
    fn shows(&mut self, name: &str, text: &str) {
        let file = self.path(name);
        fs::write(&file, text).expect("a model");
        self.harness.state_mut().models().take_chosen(&file);
        self.until("the model", |editor| editor.evaluation.model.loaded().1);
    }
}

#[test]
fn a_failed_save_is_reported_until_the_user_closes_it_or_a_save_succeeds() {
    let mut window = Window::opened(CLOUDS);
    let file = window.path("graph.sabi");
    let told = format!(
        "{} is write-protected; allow writing to it, or save under another name",
        file.display()
    );
    for closes in [true, false] {
        window.mute();
        let mut permissions = fs::metadata(&file).expect("a file").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&file, permissions.clone()).expect("a file of one's own");
        window.harness.state_mut().saving().save();
        // Longer than a notice is shown.
        window
            .harness
            .state_mut()
            .shell
            .notices
            .age(std::time::Duration::from_secs(60));
        window.settle();
        assert!(window.says(&told), "{:?}", window.labels());
        if closes {
            window.press("Close the message");
        } else {
            #[expect(clippy::permissions_set_readonly_false, reason = "the file is the test's own")]
            permissions.set_readonly(false);
            fs::set_permissions(&file, permissions).expect("a file of one's own");
            window.harness.state_mut().saving().save();
            window.settle();
        }
        assert!(!window.has_failure("write-protected"));
    }
}

#[test]
fn the_message_about_a_failed_save_leads_to_saving_elsewhere() {
    let mut window = Window::opened(CLOUDS);
    window
        .harness
        .state_mut()
        .shell
        .notices
        .fail(Work::Save, "the disk is full");
    window.settle();
    window.press("Save as…");
    assert!(window.says("Save the graph") && !window.has_failure("the disk is full"));
}

#[test]
fn a_failed_export_is_reported_whichever_panel_is_in_front() {
    let mut window = Window::opened(
        r#""clouds": { "kind": "noise/simplex", "label": "Old stains", "pos": [0, 0] },
           "out": { "kind": "output/material", "inputs": { "material": "clouds" }, "pos": [260, 0] }"#,
    );
    window.until_model();
    window.open(Panel::History);
    let editor = window.harness.state_mut();
    editor.shell.settings.export.size = 64;
    editor.exports.place.folder = "maps".to_owned();
    editor.perform_export(ExportAction::Start { force: false });
    window.until("the end", |editor| editor.exports.running.is_none());
    let folder = window.path("maps");
    assert!(
        window.says(&format!("The textures were not exported to {}", folder.display())),
        "{:?}",
        window.labels()
    );
    assert!(window.says("but 'Old stains' gives a mask"), "{:?}", window.labels());
    window.press("Close the message");
    assert!(!window.has_failure("were not exported"));
}

#[test]
fn warnings_about_a_model_have_badges_at_the_model_and_in_the_status_bar() {
    let mut window = Window::opened(CLOUDS);
    window.until_model();
    assert!(!window.says("warning"), "{:?}", window.labels());
    window.shows("stacked.obj", STACKED);
    window.until("the warnings", |editor| {
        !editor.evaluation.faults.all.warnings.is_empty()
    });
    let count = window.editor().evaluation.model.warnings().len();
    let words = crate::model_warnings::counted(count);
    let sentence = window.editor().evaluation.model.warnings()[0].sentence.clone();
    assert!(!window.says(&sentence));
    window.click_label(&format!("{words} about stacked"));
    assert!(window.says(&sentence), "{:?}", window.labels());
    window.open(Panel::History);
    assert!(!window.says(&sentence));
    // The texts left of the number in the status bar, such as the time of the evaluation, change while it runs.
    window.until("rest", |editor| !editor.evaluation.is_busy());
    let all = crate::model_warnings::counted(window.editor().evaluation.faults.all.warnings.len());
    let told = window.harness.query_all_by_label_contains(&all);
    let mut in_status = told.map(|node| node.rect().center()).filter(|at| at.y > 870.0);
    let status = in_status.next().expect("the number in the status bar");
    drop(in_status);
    window.click_at(status);
    assert!(window.says(&sentence));
}

#[test]
fn the_bench_and_the_crate_give_no_warnings_at_the_usual_size() {
    const USUAL: u32 = 512;
    let mut window = Window::with(|folders| {
        let file = beside(folders).join("graph.sabi");
        fs::write(&file, graph_text("").replace("64", "512")).expect("a graph");
        Session::open(&file, None).expect("a graph")
    });
    let folder = window.path("own");
    let is_meant = |file: &std::path::PathBuf| file.ends_with("bench.glb") || file.ends_with("crate.glb");
    for file in examples::models(&folder).filter(is_meant) {
        examples::write_model(&folder, &file).expect("a model");
        window.harness.state_mut().models().take_chosen(&file);
        window.until("the model at its full size", |editor| {
            let model = &editor.evaluation.model;
            model.loaded().1 && model.received.as_ref().is_some_and(|model| model.size == USUAL)
        });
        let model = &window.editor().evaluation.model;
        assert_eq!((model.file(), model.warnings()), (file.as_path(), [].as_slice()));
    }
}

#[test]
fn a_missing_picture_is_found_again_with_the_model_that_lies_beside_it() {
    let mut window = Window::with(|folders| {
        let folder = beside(folders);
        fs::create_dir_all(folder.join("moved")).expect("a folder");
        let picture = image::RgbImage::from_pixel(2, 2, image::Rgb([200, 100, 50]));
        picture.save(folder.join("moved/rust.png")).expect("a picture");
        fs::write(folder.join("moved/hero.obj"), STACKED).expect("a model");
        let text = graph_text(r#""photo": { "kind": "source/image", "params": { "file": "old/rust.png" } }"#);
        let text = text.replace(r#""size": 64"#, r#""size": 64, "mesh": "old/hero.obj""#);
        let file = folder.join("graph.sabi");
        fs::write(&file, text).expect("a graph");
        Session::open(&file, None).expect("a graph")
    });
    window.until("the fault", |editor| editor.evaluation.faults.of("photo").is_some());
    window.open(Panel::Problems);
    assert!(window.says("There is no file old/rust.png") && window.says("There is no file old/hero.obj"));
    window.press("Find rust.png");
    assert!(window.says("Find a missing file"));
    // Typed without selecting anything: the missing name is replaced as a whole.
    window.typed(&window.path("moved/rust.png").display().to_string());
    window.key(Key::Enter);
    window.until("the picture and the model", |editor| {
        editor.evaluation.faults.of("photo").is_none()
            && editor.evaluation.model.loaded().1
            && editor.evaluation.model.file().ends_with("moved/hero.obj")
    });
    assert!(window.says("and one more that lies beside it"));
    assert!(!window.says("There is no file"));
    let text = window.text();
    assert!(
        text.contains("moved/rust.png") && text.contains("moved/hero.obj"),
        "{text}"
    );
    window.undo(1);
    assert!(window.text().contains("old/rust.png"), "one step");
}

#[test]
fn pictures_of_a_model_are_found_beside_one_of_them_and_the_graph_keeps_the_folder() {
    let mut window = Window::opened(CLOUDS);
    window.until_model();
    let moved = window.path("moved");
    fs::create_dir_all(moved.join("deep")).expect("a folder");
    let picture = image::RgbImage::from_pixel(2, 2, image::Rgb([200, 100, 50]));
    for name in ["wood.png", "deep/rust.png"] {
        picture.save(moved.join(name)).expect("a picture");
    }
    let look = "newmtl a\nmap_Kd old/wood.png\nnorm old/rust.png\n";
    fs::write(window.path("textured.mtl"), look).expect("a material");
    let model = format!("mtllib textured.mtl\nusemtl a\n{STACKED}");
    window.shows("textured.obj", &model);
    window.until("the pictures that are gone", |editor| {
        let model = editor.evaluation.model.received.as_ref();
        model.is_some_and(|model| model.linked.model.missing_pictures().len() == 2)
    });
    window.open(Panel::Problems);
    assert!(window.says("There is no file wood.png") && window.says("There is no file rust.png"));
    window.press("Find wood.png");
    window.answer_path(&moved.join("wood.png"));
    window.until("the pictures", |editor| {
        let model = editor.evaluation.model.received.as_ref();
        editor.evaluation.model.loaded().1
            && model.is_some_and(|model| model.linked.model.missing_pictures().is_empty())
    });
    assert!(!window.says("There is no file"), "{:?}", window.labels());
    window.keys(egui::Modifiers::COMMAND, egui::Key::S);
    window.settle();
    let saved = fs::read_to_string(window.path("graph.sabi")).expect("the graph");
    assert!(saved.contains(r#""textures": "moved""#), "{saved}");
    let mtl = fs::read_to_string(window.path("textured.mtl")).expect("the material");
    assert_eq!(mtl, look, "the model's own files stay as they are");
}

#[test]
fn each_graph_has_a_strip_of_models_of_its_own() {
    let mut window = Window::opened(CLOUDS);
    window.until_model();
    window.shows("stacked.obj", STACKED);
    let names = |window: &Window| -> Vec<String> {
        let files = window.editor().documents.models.files.iter();
        files
            .map(|file| file.file_stem().unwrap_or_default().to_string_lossy().into_owned())
            .collect()
    };
    assert_eq!(names(&window), ["cube", "stacked"]);
    let other = window.path("other.sabi");
    fs::write(&other, graph_text("")).expect("a graph");
    window.harness.state_mut().open_file(&other);
    assert_eq!(names(&window), ["stacked"], "the one that is shown");
    let first = window.path("graph.sabi");
    window.harness.state_mut().open_file(&first);
    assert_eq!(names(&window), ["cube", "stacked"]);
    window.harness.state_mut().save_settings();
    let folder = window.folder;
    drop(window.harness);
    let next = Window::in_folder(folder, |_| Session::open(&first, None).expect("a graph"));
    assert_eq!(names(&next), ["cube", "stacked"], "also after the next start");
}

/// A grid without UVs, which takes a while to unwrap.
fn write_grid(file: &Path, side: usize) {
    let mut text = String::new();
    for at in 0..(side + 1) * (side + 1) {
        let (x, y) = (at % (side + 1), at / (side + 1));
        let _ = writeln!(text, "v {x} {} {y}", (x * 7 + y * 13) % 5);
    }
    for at in 0..side * side {
        let first = at / side * (side + 1) + at % side + 1;
        let _ = writeln!(
            text,
            "f {first} {} {} {}",
            first + 1,
            first + side + 2,
            first + side + 1
        );
    }
    fs::write(file, text).expect("a model");
}

#[test]
fn reading_the_first_model_can_be_canceled_for_a_built_in_one_and_repeated_later() {
    let folder = tempfile::tempdir().expect("a folder");
    let folders = super::folders_in(folder.path());
    let grid = folder.path().join("grid.obj");
    write_grid(&grid, 160);
    let mut window = Window::beginning_on(folder, folders, &grid, |folders| {
        let file = super::beside(folders).join("graph.sabi");
        let text = super::graph_text(CLOUDS).replacen("\"size\"", "\"mesh\": \"grid.obj\", \"size\"", 1);
        fs::write(&file, text).expect("a graph");
        Session::open(&file, None).expect("a graph that can be read")
    });
    window.settle();
    assert!(window.editor().evaluation.model.is_first(), "it is being read");
    window.press("Cancel reading the model");
    window.until("another model", |editor| editor.evaluation.model.loaded().1);
    assert_ne!(window.editor().evaluation.model.file(), grid);
    assert!(window.editor().evaluation.model.file().ends_with("meshes/bench.glb"));
    assert!(
        window.says("Grid was not read; bench is shown"),
        "{:?}",
        window.labels()
    );
    window.keys(egui::Modifiers::COMMAND, egui::Key::S);
    window.settle();
    let saved = fs::read_to_string(window.path("graph.sabi")).expect("the graph");
    assert!(saved.contains("grid.obj"), "the graph keeps its model: {saved}");
    window.open(Panel::Problems);
    assert!(window.says("grid, the model of the graph, was not read; bench stands in for it"));
    window.press("Read grid again");
    window.until("the grid", |editor| {
        editor.evaluation.model.loaded().1 && editor.evaluation.model.file().ends_with("grid.obj")
    });
    assert!(!window.says("stands in for it"));
}

#[test]
fn reading_a_model_can_be_canceled_and_the_previous_one_stays() {
    let mut window = Window::opened(CLOUDS);
    window.until("a picture of the model", |editor| editor.views.model.pictures.drawn > 0);
    let before = window.editor().evaluation.model.file().to_owned();
    let grid = window.path("grid.obj");
    write_grid(&grid, 400);
    window.harness.state_mut().models().take_chosen(&grid);
    window.settle();
    assert!(window.editor().evaluation.model.is_replacing());
    window.until("the cover", |editor| {
        editor
            .evaluation
            .results
            .picture(&editor.seen())
            .is_some_and(|picture| editor.evaluation.is_outdated(picture))
    });
    window.press("Cancel reading the model");
    assert_eq!(window.editor().evaluation.model.file(), before);
    window.until("rest", |editor| !editor.evaluation.is_busy());
    assert!(window.editor().evaluation.model.loaded().1);
    assert!(!window.editor().documents.models.files.contains(&grid));
    let added = window.add([0.3, 0.3], "invert");
    window.until("its picture", |editor| editor.thumbnail_of(&added).is_some());
}
