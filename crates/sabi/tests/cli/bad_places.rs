//! Files and folders that cannot be written to.

use std::fs;
use std::process::{Command, Stdio};

use crate::cli_folder::{CliFolder, done};

#[test]
fn a_folder_that_cannot_be_made_is_found_before_the_work() {
    let place = CliFolder::new();
    place.write("file", "mine");
    let advice = "choose another folder with -o";
    place.refuses(
        "clouds.sabi",
        "cube.glb",
        &["-o", "file"],
        73,
        &format!("cannot create the folder file: a file of that name is in the way; {advice}"),
    );
    place.refuses(
        "clouds.sabi",
        "cube.glb",
        &["-o", "file/below"],
        73,
        &format!("cannot create the folder file/below: a part of its path is a file, not a folder; {advice}"),
    );
    assert_eq!(place.read("file"), b"mine");
}

#[test]
fn somebody_elses_folder_is_refused_unless_forced() {
    let place = CliFolder::new();
    fs::create_dir(place.path("photos")).unwrap();
    place.write("photos/holiday.png", "mine");
    place.refuses(
        "clouds.sabi",
        "cube.glb",
        &["-o", "photos"],
        73,
        "the folder photos has files but no earlier maps; choose another folder with -o, or write into this folder anyway with \
         --force",
    );
    assert_eq!(place.listing("photos"), ["holiday.png"]);
    place
        .bake("clouds.sabi", "cube.glb", &["-o", "photos", "--force"])
        .good();
    assert_eq!(place.listing("photos"), ["cube_mask.png", "holiday.png"]);
    assert_eq!(place.read("photos/holiday.png"), b"mine");
    place.bake("clouds.sabi", "cube.glb", &["-o", "photos"]).good();
    fs::create_dir(place.path("empty")).unwrap();
    place.write("empty/.gitkeep", "");
    place.bake("clouds.sabi", "cube.glb", &["-o", "empty"]).good();
}

#[test]
fn a_report_that_cannot_be_written_is_found_before_the_work() {
    let place = CliFolder::new();
    let refuse = |report: &str, words: &str| {
        place.refuses("clouds.sabi", "cube.glb", &["--report", report], 73, words);
    };
    refuse(
        "none/report.json",
        "cannot write the report none/report.json: there is no folder none; make it, or name another file",
    );
    refuse(
        ".",
        "cannot write the report .: a folder of that name is in the way; name another file",
    );
    refuse(
        "cube.glb/report.json",
        "cannot write the report cube.glb/report.json: a part of its path is a file, not a folder; name another file",
    );
    let report = ["--report", "report.json", "--material", "none"];
    place.bake("clouds.sabi", "cube.glb", &report).fails(2);
    let report: serde_json::Value = serde_json::from_slice(&place.read("report.json")).unwrap();
    assert_eq!(
        report["error"]["exit"], 2,
        "a bake that fails says so in its report: {report}"
    );
}

/// A limit on the size of files replaces a disk that becomes full while the maps are written.
#[cfg(unix)]
#[test]
fn a_disk_that_fills_up_leaves_the_earlier_maps_as_they_were() {
    let place = CliFolder::new();
    place.bake("rust.sabi", "sphere.glb", &["--no-cache"]).good();
    let maps = place.listing("out");
    let before: Vec<Vec<u8>> = maps.iter().map(|map| place.read(&format!("out/{map}"))).collect();
    let sabi = env!("CARGO_BIN_EXE_sabi");
    let bake = "bake rust.sabi --mesh sphere.glb -o out --size 128 --adapter cpu --no-cache --set base.color=#ff0000";
    let script = format!("trap '' XFSZ; ulimit -f 8; exec \"$0\" {}", bake.replace('#', "\\#"));
    let mut limited = Command::new("sh");
    limited
        .args(["-c", &script, sabi])
        .current_dir(place.path("."))
        .env("XDG_RUNTIME_DIR", place.path("."))
        .env("SABI_NODES", place.path(".nodes"))
        .env("MESA_SHADER_CACHE_DISABLE", "true")
        .stdin(Stdio::null());
    let run = done(limited.output().unwrap()).fails(73);
    assert!(
        run.stderr.starts_with("error: cannot write out/sphere_"),
        "{}",
        run.stderr
    );
    assert!(
        run.stderr.contains(", so nothing was changed: ") && run.stderr.ends_with("; choose another folder with -o\n"),
        "{}",
        run.stderr
    );
    assert_eq!(place.listing("out"), maps, "nothing half is left");
    for (map, before) in maps.iter().zip(before) {
        assert!(place.read(&format!("out/{map}")) == before, "{map}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_listener_that_hangs_up_is_no_error_and_a_full_one_is() {
    use std::fs::File;

    let place = CliFolder::new();
    let mut child = place
        .command(&["nodes", "--json"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let full = File::options().write(true).open("/dev/full").unwrap();
    let run = place
        .command(&["nodes"])
        .stdout(full)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let run = done(run.wait_with_output().unwrap()).fails(73);
    assert_eq!(run.stderr, "error: cannot write to standard output: the disk is full\n");
}
