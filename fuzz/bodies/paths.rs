//! Any model with any files around it loads or is refused, within its memory, and nothing above its folder counts.

use std::fs;
use std::path::Path;

use sabi_files::{TrustedPaths, canonical};
use sabi_surface::load::{LoadOptions, load_trusting};
use sabi_surface::model::Model;

use crate::parts::files;
use crate::promises;

/// Memory for a model.
const MEMORY_BYTES: u64 = 64 << 20;
/// Most files of an input.
const MOST_FILES: usize = 8;
/// Files above the folder of the model.
const OUTSIDE: [&str; 4] = ["secret.bin", "secret.mtl", "secret.png", "other/secret.bin"];
/// Two contents of them: material libraries, and buffers of small numbers.
const SECRETS: [&str; 2] = [
    "newmtl a\nKd 0.25 0.5 0.75\nmap_Kd b.png\n",
    "newmtl a\nKd 0.75 0.5 0.25 \nmap_Kd c.png\nnewmtl b\n",
];

pub fn survives(bytes: &[u8]) {
    let root = tempfile::tempdir().expect("a temporary folder");
    let folder = root.path().join("model");
    fs::create_dir_all(root.path().join("other")).expect("a new folder");
    fs::create_dir_all(folder.join("sub")).expect("a new folder");
    add_traps(&folder);
    let all = files(bytes, MOST_FILES);
    let path = folder.join(name_of(all[0]));
    fs::write(&path, all[0]).expect("a new file");
    for file in &all[1..] {
        write_beside(&folder, file);
    }
    let [one, other] = SECRETS.map(|secret| {
        for name in OUTSIDE {
            fs::write(root.path().join(name), secret.repeat(40)).expect("a new file");
        }
        loaded(&path, &folder)
    });
    assert!(is_same(&one, &other), "a file outside of the folder was read");
}

/// Name of a model file by its first bytes.
fn name_of(file: &[u8]) -> &'static str {
    let starts: [(&[u8], &str); 7] = [
        (b"glTF", "model.glb"),
        (b"{", "model.gltf"),
        (b"ply", "model.ply"),
        (b"<", "model.dae"),
        (b"Kaydara", "model.fbx"),
        (b"; FBX", "model.fbx"),
        (b"solid", "model.stl"),
    ];
    let found = starts.iter().find(|(start, _)| file.starts_with(start));
    found.map_or("model.obj", |(_, name)| *name)
}

/// Adds what leads out of the folder, and a pipe that nobody writes to.
fn add_traps(folder: &Path) {
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("../secret.bin", folder.join("link.bin")).expect("a link");
        symlink("../other", folder.join("out")).expect("a link");
        symlink("/dev/zero", folder.join("zero.bin")).expect("a link");
        // One for the whole process: making it takes a program.
        static PIPES: std::sync::OnceLock<tempfile::TempDir> = std::sync::OnceLock::new();
        let pipes = PIPES.get_or_init(|| {
            let pipes = tempfile::tempdir().expect("a temporary folder");
            let made = std::process::Command::new("mkfifo")
                .arg(pipes.path().join("pipe"))
                .status();
            assert!(made.is_ok_and(|status| status.success()), "mkfifo is missing");
            pipes
        });
        fs::hard_link(pipes.path().join("pipe"), folder.join("pipe.bin")).expect("a second name");
    }
    #[cfg(not(unix))]
    let _ = folder;
}

/// Writes a file that begins with its name, unless that leads elsewhere or is taken.
fn write_beside(folder: &Path, file: &[u8]) {
    let Some(end) = file.iter().position(|byte| *byte == b'\n') else {
        return;
    };
    let (name, content) = (&file[..end], &file[end + 1..]);
    let Ok(name) = std::str::from_utf8(name) else {
        return;
    };
    let bare = name.strip_prefix("sub/").unwrap_or(name);
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._- ".contains(c);
    let is_file = bare.len() < 64 && bare.chars().all(is_plain) && !bare.trim_matches(['.', ' ']).is_empty();
    let path = folder.join(name);
    if is_file && !path.exists() {
        fs::write(path, content).expect("a new file");
    }
}

/// Loads a model twice as strangers' models are, and checks what it read.
fn loaded(path: &Path, folder: &Path) -> Result<Model, String> {
    let options = LoadOptions {
        memory_bytes: MEMORY_BYTES,
        ..LoadOptions::default()
    };
    let model = load_trusting(path, &TrustedPaths::of_file(path), &options).map_err(|error| error.to_string())?;
    promises::check(&model);
    assert!(model.file_bytes <= MEMORY_BYTES);
    let folder = canonical(folder).expect("it is there");
    for file in &model.files {
        assert!(
            canonical(file).is_ok_and(|file| file.starts_with(&folder)),
            "{} was read",
            file.display()
        );
    }
    Ok(model)
}

fn is_same(one: &Result<Model, String>, other: &Result<Model, String>) -> bool {
    let texts = |model: &Model| {
        let names = (&model.stem, &model.parts, &model.files, &model.refused, &model.warnings);
        format!("{names:?} {:?} {:?} {:?}", model.absent, model.materials, model.images)
    };
    match (one, other) {
        (Ok(one), Ok(other)) => one.mesh == other.mesh && texts(one) == texts(other),
        (Err(one), Err(other)) => one == other,
        _ => false,
    }
}
