//! Tests of paths written in files.

use super::*;

fn base(folder: &str) -> PathBase {
    PathBase::of_folder(folder)
}

#[test]
fn a_path_is_relative_to_the_folder_of_the_file_that_contains_it() {
    let graph = PathBase::of_file(Path::new("/w/graphs/rust.sabi"));
    assert_eq!(graph.folder(), Path::new("/w/graphs"));
    assert_eq!(graph.resolve("../a.png"), Path::new("/w/graphs/../a.png"));
    assert_eq!(graph.resolve("/x/a.png"), Path::new("/x/a.png"));
    let group = graph.base_of("lib/worn.sabi");
    assert_eq!(group.resolve("a.png"), Path::new("/w/graphs/lib/a.png"));
    assert_eq!(
        PathBase::of_file(Path::new("rust.sabi")).resolve("a.png"),
        Path::new("a.png")
    );
}

#[test]
fn a_backslash_separates_folders_unless_a_file_name_contains_it() {
    let folder = tempfile::tempdir().unwrap();
    let graph = base(folder.path().to_str().unwrap());
    assert_eq!(graph.resolve("b\\a.png"), folder.path().join("b/a.png"));
    if cfg!(unix) {
        fs::write(folder.path().join("b\\a.png"), b"1").unwrap();
        assert_eq!(graph.resolve("b\\a.png"), folder.path().join("b\\a.png"));
    }
}

#[test]
fn a_file_of_a_model_is_searched_in_three_places() {
    let model = base("/w");
    let places = |written| {
        model
            .places(written)
            .map(|(_, place)| place.to_str().unwrap().to_owned())
    };
    assert_eq!(places("a.png"), ["/w/a.png"; 3]);
    assert_eq!(places("t/a.png"), ["/w/t/a.png", "/w/t/a.png", "/w/a.png"]);
    if cfg!(unix) {
        assert_eq!(places("C:\\t\\a.png"), ["/w/C:\\t\\a.png", "/w/C:/t/a.png", "/w/a.png"]);
    }
}

#[test]
fn a_file_of_a_model_may_be_named_in_another_case_of_letters() {
    let folder = tempfile::tempdir().unwrap();
    let model = PathBase::of_folder(folder.path());
    fs::create_dir(folder.path().join("Textures")).unwrap();
    for name in ["Textures/Wood.PNG", "Textures/wood.jpg", "b.png", "B.PNG"] {
        fs::write(folder.path().join(name), b"1").unwrap();
    }
    let found = |written: &str| model.place_in_other_case(written).map(|(text, _)| text);
    for (written, expected) in [
        ("textures/wood.png", Some("Textures/Wood.PNG")),
        ("./TEXTURES/WOOD.JPG", Some("Textures/wood.jpg")),
        ("Textures/oak.png", None),
        ("../textures/wood.png", None),
        ("/textures/wood.png", None),
        ("", None),
    ] {
        let found = found(written);
        assert!(
            found.as_deref().map(str::to_lowercase) == expected.map(str::to_lowercase),
            "{written}: {found:?}"
        );
    }
    let (text, place) = model.place_in_other_case("textures/wood.png").unwrap();
    assert_eq!(place, folder.path().join(&text));
    assert_eq!(fs::read(place).unwrap(), b"1");
}

#[test]
fn a_path_is_written_relative_to_the_folder_where_both_share_more_than_the_root() {
    for (target, folder, written) in [
        ("/w/a.png", "/w", "a.png"),
        ("/w/b/a.png", "/w/c/d", "../../b/a.png"),
        ("/v/a.png", "/w", "/v/a.png"),
        ("/w/a.png", "/", "/w/a.png"),
        ("/w/b/a.png", "/w/x/../c/./d", "../../b/a.png"),
    ] {
        assert_eq!(base(folder).write(Path::new(target)).unwrap(), written);
    }
}

#[test]
fn a_path_refers_to_the_same_file_after_a_move_to_another_folder() {
    for (path, from, to, written) in [
        ("a.png", "/w/here", "/w/there", "../here/a.png"),
        ("a.png", "/w", "/w/there", "../a.png"),
        ("there/a.png", "/w", "/w/there", "a.png"),
        ("../a.png", "/w/here", "/w", "a.png"),
        ("./b/../a.png", "/w", "/w/x/y", "../../a.png"),
        ("b\\a.png", "/w", "/w/x", "../b/a.png"),
        ("../../../a.png", "/w", "/v", "../a.png"),
        ("/x/a.png", "/w", "/v", "/x/a.png"),
        ("C:\\x\\a.png", "/w", "/v", "C:\\x\\a.png"),
        ("", "/w", "/v", ""),
    ] {
        assert_eq!(
            base(to).rewrite(path, &base(from), AbsolutePaths::Keep).unwrap(),
            written,
            "{path} from {from} to {to}"
        );
    }
}

#[test]
fn absolute_paths_near_the_new_folder_can_be_shortened() {
    for (path, to, written) in [
        ("/w/assets/a.png", "/w/graphs", "../assets/a.png"),
        ("/w/a.png", "/w", "a.png"),
        ("/x/a.png", "/w", "/x/a.png"),
        ("b/a.png", "/w", "../here/b/a.png"),
        ("", "/w", ""),
    ] {
        let rewritten = base(to).rewrite(path, &base("/here"), AbsolutePaths::Shorten);
        assert_eq!(rewritten.unwrap(), written, "{path} in {to}");
    }
}

#[test]
fn an_absolute_path_contains_no_dots() {
    for (path, written) in [
        ("a.png", "/w/here/a.png"),
        ("..\\a.png", "/w/a.png"),
        ("./../../../a.png", "/a.png"),
        ("/x/./a.png", "/x/a.png"),
        (" ", " "),
    ] {
        assert_eq!(base("/w/here").rewrite_absolute(path).unwrap(), written);
    }
    assert_eq!(without_detours(Path::new("../a/../b")), Path::new("../b"));
}

#[cfg(unix)]
#[test]
fn a_path_that_is_not_text_is_refused_unless_only_its_folder_is_not() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = Path::new("/w").join(OsStr::from_bytes(b"\xff"));
    let own = PathBase::of_folder(&folder);
    assert_eq!(own.write(&folder.join("b/a.png")).unwrap(), "b/a.png");
    assert_eq!(own.write(Path::new("/w/a.png")).unwrap(), "../a.png");
    let refused = base("/w").write(&folder.join("a.png")).unwrap_err();
    assert_eq!(refused.path, Path::new(OsStr::from_bytes(b"\xff/a.png")));
    assert!(
        refused.to_string().ends_with("its name is not Unicode text; rename it"),
        "{refused}"
    );
    assert!(base("/w").rewrite("a.png", &own, AbsolutePaths::Keep).is_err());
}
