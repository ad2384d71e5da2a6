//! Every fault of the disk at every step of a bake. Each map is either the earlier or the new one, and a folder with both
//! never counts as finished.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use sabi_files::{Disk, is_temporary_name};
use sabi_gpu::AdapterChoice;

use crate::baking::bake::bake;
use crate::baking::bake_request::BakeRequest;
use crate::baking::recorded::manifest::finished_bake;
use crate::phases::NoProgress;

/// A graph that gives a color and a roughness everywhere.
fn graph(color: &str, roughness: f32) -> String {
    format!(
        r#"{{ "format": "sabi", "version": 1, "nodes": {{
            "base": {{ "kind": "source/material", "params": {{ "color": "{color}", "roughness": {roughness} }} }},
            "out": {{ "kind": "output/material", "inputs": {{ "material": "base" }} }} }} }}"#
    )
}

/// Folder of a bake, with a graph of its own.
struct BakeFolder(tempfile::TempDir);

impl BakeFolder {
    fn request(&self, name: &str, disk: &Disk) -> BakeRequest {
        let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes/cube.glb");
        let mut request = BakeRequest::plain(&self.0.path().join(name), &model, 16);
        request.output = self.output();
        request.channels = vec!["base_color".to_owned(), "roughness".to_owned()];
        request.all_maps = true;
        request.evaluator.adapter = AdapterChoice::Cpu;
        request.evaluator.model.cache_dir = Some(self.0.path().join("cache"));
        request.disk = disk.clone();
        request
    }

    fn output(&self) -> PathBuf {
        self.0.path().join("maps")
    }

    /// The files that a person sees.
    fn maps(&self) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(self.output()).into_iter().flatten().flatten();
        let files = entries.filter(|entry| entry.path().is_file());
        let named = files.map(|entry| (entry.file_name().to_string_lossy().into_owned(), entry.path()));
        let shown = named.filter(|(name, _)| !is_temporary_name(name));
        shown.map(|(name, path)| (name, fs::read(path).unwrap())).collect()
    }
}

/// Copies a folder with everything in it.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().flatten() {
        let there = to.join(entry.file_name());
        match entry.path().is_dir() {
            true => copy(&entry.path(), &there),
            false => fs::copy(entry.path(), there).map(drop).unwrap(),
        }
    }
}

#[test]
fn a_bake_leaves_whole_maps_wherever_the_disk_fails_and_the_next_one_goes_through() {
    let first = BakeFolder(tempfile::tempdir().unwrap());
    for (name, text) in [
        ("old.sabi", graph("#400000", 0.25)),
        ("new.sabi", graph("#004000", 0.75)),
    ] {
        fs::write(first.0.path().join(name), text).unwrap();
    }
    bake(&first.request("old.sabi", &Disk::default()), &NoProgress).unwrap();
    let old = first.maps();
    assert_eq!(old.len(), 2, "{:?}", old.keys());
    // From now on, maps are taken from the cache.
    let again = BakeFolder(tempfile::tempdir().unwrap());
    copy(first.0.path(), again.0.path());
    let disk = Disk::counting();
    bake(&again.request("new.sabi", &disk), &NoProgress).unwrap();
    let new = again.maps();
    assert!(old.keys().eq(new.keys()) && old.iter().all(|(name, bytes)| new[name] != *bytes));
    assert_eq!(
        disk.at_risk()
            .into_iter()
            .filter(|path| !path.starts_with(again.0.path().join("cache")))
            .count(),
        0
    );
    for (disk, told) in Disk::each_fault(disk.steps()) {
        let place = BakeFolder(tempfile::tempdir().unwrap());
        copy(first.0.path(), place.0.path());
        let is_told = bake(&place.request("new.sabi", &disk), &NoProgress).is_ok();
        let maps = place.maps();
        assert!(maps.keys().eq(old.keys()), "{told}");
        for (name, bytes) in &maps {
            assert!(*bytes == new[name] || !is_told && *bytes == old[name], "{told}: {name}");
        }
        let is_finished = |name: &str| finished_bake(&place.request(name, &Disk::default())).is_some();
        assert!(!is_finished("new.sabi") || maps == new, "{told}");
        assert!(!is_finished("old.sabi") || maps == old, "{told}");
        assert!(!is_told || is_finished("new.sabi"), "{told}");
        bake(&place.request("new.sabi", &Disk::default()), &NoProgress).unwrap();
        assert!(place.maps() == new && is_finished("new.sabi"), "{told}");
    }
}
