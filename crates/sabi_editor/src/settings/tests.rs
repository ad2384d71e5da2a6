//! Tests of the settings' file.

use serde_json::json;

use super::*;

#[test]
fn saved_settings_are_read_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut kept = Settings {
        scale: 1.5,
        input_preset: InputPreset::Blender,
        ..Settings::default()
    };
    kept.remember(Path::new("one.sabi"));
    kept.remember(Path::new("two.sabi"));
    kept.remember(Path::new("one.sabi"));
    kept.save(folder.path(), &Json::Null).expect("saved");
    let (read, fault) = Settings::load(Some(folder.path()));
    assert_eq!(fault, None);
    assert_eq!((read.scale, read.input_preset), (1.5, InputPreset::Blender));
    assert_eq!(read.recent, [PathBuf::from("one.sabi"), PathBuf::from("two.sabi")]);
}

#[cfg(unix)]
#[test]
fn settings_with_a_path_that_is_not_utf_8_are_read_again() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().expect("a folder");
    let file = Path::new(std::ffi::OsStr::from_bytes(b"/no such folder/a\xff.sabi"));
    let mut kept = Settings::default();
    kept.remember(file);
    kept.models.push(file.to_owned());
    kept.remember_export(file, &ExportPlace::default());
    kept.readings.insert(file.to_owned(), ImportOptions::default());
    kept.save(folder.path(), &Json::Null).expect("saved");
    let (read, fault) = Settings::load(Some(folder.path()));
    assert_eq!(fault, None);
    assert_eq!(
        (read.recent.as_slice(), read.models.as_slice()),
        ([file.to_owned()].as_slice(), [file.to_owned()].as_slice())
    );
    assert!(read.export_places.contains_key(file) && read.readings.contains_key(file));
}

#[test]
fn unreadable_settings_are_reported_put_aside_and_replaced_by_new_ones() {
    for damaged in [b"{ \"scale\": \"huge\" }".as_slice(), b"{ \"scale\": 1.5 \xff }"] {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join(FILE), damaged).expect("written");
        let (read, fault) = Settings::load(Some(folder.path()));
        assert_eq!(read.scale, 1.0);
        assert!(fault.expect("a sentence").starts_with("The settings could not be read"));
        assert_eq!(fs::read(folder.path().join(ASIDE)).expect("a file"), damaged);
    }
}

#[test]
fn changes_of_two_windows_are_both_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let began = Settings::default();
    let (mut one, mut other) = (began.clone(), began.clone());
    one.input_preset = InputPreset::Blender;
    one.save(folder.path(), &began.to_json()).expect("saved");
    other.scale = 1.5;
    other.save(folder.path(), &began.to_json()).expect("saved");
    let (read, _) = Settings::load(Some(folder.path()));
    assert_eq!((read.scale, read.input_preset), (1.5, InputPreset::Blender));
}

#[test]
fn lists_and_maps_keep_what_each_window_added_and_lose_what_one_removed() {
    let folder = tempfile::tempdir().expect("a folder");
    let began = Settings {
        models: ["a.glb", "b.glb"].map(PathBuf::from).to_vec(),
        ..Settings::default()
    };
    began.save(folder.path(), &Json::Null).expect("saved");
    let (mut one, mut other) = (began.clone(), began.clone());
    one.remember(Path::new("one.sabi"));
    one.models.remove(0);
    one.keys.insert("save".to_owned(), vec!["F2".to_owned()]);
    one.brush_colors.push([0.0, 0.5, 1.0]);
    one.save(folder.path(), &began.to_json()).expect("saved");
    other.remember(Path::new("other.sabi"));
    other.models.push(PathBuf::from("c.glb"));
    other.keys.insert("open".to_owned(), vec!["F3".to_owned()]);
    other.brush_colors.push([0.0, 0.5, 0.0]);
    other.save(folder.path(), &began.to_json()).expect("saved");
    let (read, fault) = Settings::load(Some(folder.path()));
    assert_eq!(fault, None);
    assert_eq!(read.recent, ["other.sabi", "one.sabi"].map(PathBuf::from));
    assert_eq!(read.models, ["b.glb", "c.glb"].map(PathBuf::from));
    assert_eq!(read.brush_colors, [[0.0, 0.5, 0.0], [0.0, 0.5, 1.0]]);
    let keys: Vec<&str> = read.keys.keys().map(String::as_str).collect();
    assert_eq!(keys, ["open", "save"]);
}

#[test]
fn settings_damaged_by_another_program_are_put_aside_before_the_next_save() {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = Settings::default();
    fs::write(folder.path().join(FILE), "theirs").expect("written");
    let told = settings
        .save(folder.path(), &Json::Null)
        .expect("saved")
        .expect("a sentence");
    assert_eq!(
        told,
        "Another program has damaged the settings, which were saved again. What it wrote is in settings.json.bak."
    );
    assert_eq!(fs::read_to_string(folder.path().join(ASIDE)).expect("a file"), "theirs");
    assert_eq!(settings.save(folder.path(), &Json::Null), Ok(None));
}

#[test]
fn settings_of_a_newer_version_are_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join(FILE), r#"{ "scale": 2.0, "newer": [1] }"#).expect("written");
    let (read, _) = Settings::load(Some(folder.path()));
    let changed = Settings {
        scale: 1.5,
        ..read.clone()
    };
    changed.save(folder.path(), &read.to_json()).expect("saved");
    let text = fs::read_to_string(folder.path().join(FILE)).expect("a file");
    let kept: Json = serde_json::from_str(&text).expect("settings");
    assert_eq!((&kept["newer"][0], &kept["scale"]), (&Json::from(1), &Json::from(1.5)));
}

/// Calls `see` with every value inside of a value, deepest first.
fn each_value(value: &mut Json, see: &mut dyn FnMut(&mut Json)) {
    match value {
        Json::Array(items) => items.iter_mut().for_each(|item| each_value(item, see)),
        Json::Object(fields) => fields.values_mut().for_each(|field| each_value(field, see)),
        _ => {}
    }
    see(value);
}

#[test]
fn settings_with_any_value_replaced_by_any_other_are_read_or_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = Path::new("a.sabi");
    let mut whole = Settings::default();
    whole.remember(file);
    whole.remember_export(file, &ExportPlace::default());
    whole.readings.insert(file.to_owned(), ImportOptions::default());
    whole.remember_brush_color();
    let whole = whole.to_json();
    let mut count = 0;
    each_value(&mut whole.clone(), &mut |_| count += 1);
    assert!(count > 50, "{count}");
    let others = [
        Json::Null,
        json!(true),
        json!(-1),
        json!(1e308),
        json!(u64::MAX),
        json!(""),
        json!("x".repeat(100_000)),
        json!([]),
        json!([[], {}, null]),
        json!({ "": 0 }),
    ];
    for (at, other) in (0..count).flat_map(|at| others.iter().map(move |other| (at, other))) {
        let (mut damaged, mut index) = (whole.clone(), 0);
        each_value(&mut damaged, &mut |value| {
            if index == at {
                *value = other.clone();
            }
            index += 1;
        });
        fs::write(folder.path().join(FILE), damaged.to_string()).expect("written");
        let (read, fault) = Settings::load(Some(folder.path()));
        assert!(fault.is_none_or(|why| why.starts_with("The settings could not be read")));
        assert!(
            (0.5..=3.0).contains(&read.scale) && read.brush_colors.len() <= MOST_COLORS,
            "{damaged}"
        );
        let numbers = read.brush_colors.iter().flatten().chain(&read.brush.color);
        assert!(numbers.copied().all(f32::is_finite), "{damaged}");
    }
}
