use std::fs;

use sabi_files::TrustedPaths;

use super::*;

const GOOD: &str = "//! Good\n//! A test.\n//! @was test/former\n//! @use wave\n\n/// The mask.\nfn mask(at: Surface) -> f32 {\n    return wave(at.uv.x);\n}\n";
const BAD: &str = "//! Bad\n//! A test.\n\n/// The mask.\nfn mask(at: Surface) -> f32 {\n    return nothing;\n}\n";
const WAVE: &str = "fn wave(x: f32) -> f32 { return sin(x); }\n";

fn file(id: &str, text: &str) -> SourceFile {
    SourceFile {
        path: PathBuf::from(format!("{id}.wgsl")),
        id: id.to_owned(),
        text: text.to_owned(),
    }
}

fn libraries(others: &[(&str, &str)]) -> Libraries {
    let mut libraries = Libraries::default();
    let core = Library::builtin_files().1.text("core").unwrap().to_owned();
    libraries.0.insert("core".to_owned(), core);
    for (name, text) in others {
        libraries.0.insert((*name).to_owned(), (*text).to_owned());
    }
    libraries
}

#[test]
fn a_faulty_file_does_not_affect_the_other_files() {
    let files = vec![file("test/bad", BAD), file("test/good", GOOD)];
    let (library, faults) = Library::load(files, libraries(&[("wave", WAVE)]));
    assert_eq!(
        library.kinds().map(|kind| kind.id.as_str()).collect::<Vec<_>>(),
        ["test/good"]
    );
    assert_eq!(faults.len(), 1);
    assert_eq!((faults[0].line, faults[0].column), (6, 12));
}

#[test]
fn a_kind_is_found_by_its_former_id_and_a_similar_id_is_suggested() {
    let (library, _) = Library::load(vec![file("test/good", GOOD)], libraries(&[("wave", WAVE)]));
    assert_eq!(library.kind("test/former").unwrap().id, "test/good");
    assert!(library.kind("test/other").is_none());
    assert_eq!(library.nearest("test/goood"), Some("test/good"));
    assert_eq!(library.nearest("good"), Some("test/good"));
    assert_eq!(library.nearest("noise/simplex"), None);
}

#[test]
fn a_reload_keeps_the_last_valid_version_of_a_faulty_file() {
    let (mut library, _) = Library::load(vec![file("test/good", GOOD)], libraries(&[("wave", WAVE)]));
    let before = library.kind("test/good").unwrap().clone();
    assert!(library.replace(file("test/good", BAD)).is_err());
    assert_eq!(*library.kind("test/good").unwrap(), before);
    library
        .replace(file("test/good", &GOOD.replace("Good", "Better")))
        .unwrap();
    assert_eq!(library.kind("test/good").unwrap().label, "Better");
    library.remove_folder(Path::new("tes"));
    assert!(library.kind("test/good").is_some(), "of another folder");
    library.remove_folder(Path::new("test"));
    assert!(library.kind("test/good").is_none());
}

#[test]
fn a_changed_library_is_accepted_only_if_its_nodes_remain_valid() {
    let (mut library, _) = Library::load(vec![file("test/good", GOOD)], libraries(&[("wave", WAVE)]));
    let broken = library
        .replace_library("wave", "fn wave(x: f32) -> f32 { return y; }".to_owned())
        .unwrap_err();
    assert_eq!(broken[0].path, PathBuf::from("lib/wave.wgsl"));
    let renamed = library
        .replace_library("wave", "fn waves(x: f32) -> f32 { return x; }".to_owned())
        .unwrap_err();
    assert!(renamed[0].message.contains("`wave`"));
    assert_eq!(library.libraries().text("wave"), Some(WAVE));
    let longer = "fn wave(x: f32) -> f32 { return sin(x) * cos(x) * 2.0; }";
    let cost = library.kind("test/good").unwrap().cost.all;
    library.replace_library("wave", longer.to_owned()).unwrap();
    assert!(library.kind("test/good").unwrap().cost.all > cost);
}

#[test]
fn libraries_of_libraries_are_linked_only_once() {
    let texts = [
        ("a", "//! @use b c\nfn a() -> f32 { return b() + c(); }\n"),
        ("b", "//! @use c\nfn b() -> f32 { return c(); }\n"),
        ("c", "//! @use a\nfn c() -> f32 { return 1.0; }\n"),
    ];
    let node = "//! N\n//! A test.\n//! @use c a\n\n/// The mask.\nfn mask() -> f32 { return a(); }\n";
    let (library, faults) = Library::load(vec![file("test/n", node)], libraries(&texts));
    assert_eq!(faults, []);
    assert_eq!(library.kind("test/n").unwrap().libraries, ["c", "a", "b"]);
}

#[test]
fn a_faulty_library_is_reported_once() {
    let files = vec![file("test/good", GOOD)];
    let (library, faults) = Library::load(files, libraries(&[("wave", "fn wave( {")]));
    assert_eq!(library.kinds().count(), 0);
    assert_eq!(faults[0].path, PathBuf::from("lib/wave.wgsl"));
    assert!(faults[1].message.contains("There is no library `wave`"));
    assert_eq!(faults.len(), 2);
}

#[test]
fn an_id_consists_of_a_folder_and_a_name() {
    for id in [
        "good",
        "Test/good",
        "test/",
        "/good",
        "test/go od",
        "test/a/b",
        "1/2",
        "../x",
    ] {
        let (_, faults) = Library::load(vec![file(id, GOOD)], libraries(&[("wave", WAVE)]));
        assert!(faults[0].message.contains("not a name"), "{id}");
    }
}

#[test]
fn a_users_folder_adds_nodes_and_libraries() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    };
    write("mine/good.wgsl", GOOD.as_bytes());
    write("mine/bad.wgsl", BAD.as_bytes());
    write("mine/bytes.wgsl", &[0xff, 0xfe]);
    write("mine/huge.wgsl", &vec![b' '; 300 * 1024]);
    write("mine/notes.txt", b"not a node");
    write("test/taken.wgsl", GOOD.as_bytes());
    write("lib/wave.wgsl", WAVE.as_bytes());
    write("lib/broken.wgsl", b"fn (");
    let taken = file(
        "test/taken",
        &GOOD.replace("//! @use wave\n", "").replace("wave(at.uv.x)", "at.uv.x"),
    );
    let (mut library, faults) = Library::load(vec![taken], libraries(&[]));
    assert_eq!(faults, []);
    let mut faults = library.load_folder(folder.path(), &TrustedPaths::default().with_path(folder.path()));
    faults.sort_by_key(|fault| fault.path.clone());
    let told: Vec<String> = faults
        .iter()
        .map(|fault| fault.path.file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    assert_eq!(
        told,
        ["broken.wgsl", "bad.wgsl", "bytes.wgsl", "huge.wgsl", "taken.wgsl"]
    );
    assert!(faults[3].message.contains("larger than 256 KiB"));
    assert!(library.kind("mine/good").is_some());
    assert!(library.kind("mine/huge").is_none());
    // Loading it again is a reload.
    fs::remove_file(folder.path().join("mine/bad.wgsl")).unwrap();
    assert_eq!(
        library
            .load_folder(folder.path(), &TrustedPaths::default().with_path(folder.path()))
            .len(),
        4
    );
}

#[cfg(unix)]
#[test]
fn links_in_a_node_folder_lead_to_no_file_outside_of_trusted_paths() {
    use std::os::unix::fs::symlink;

    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for name in ["graph/nodes/mine", "elsewhere/theirs", "graph/shared"] {
        fs::create_dir_all(at(name)).unwrap();
    }
    fs::write(at("elsewhere/key.txt"), "BEGIN SECRET KEY").unwrap();
    fs::write(at("elsewhere/theirs/good.wgsl"), GOOD).unwrap();
    fs::write(at("graph/shared/good.wgsl"), GOOD).unwrap();
    let nodes = at("graph/nodes");
    symlink(at("elsewhere/key.txt"), nodes.join("mine/key.wgsl")).unwrap();
    symlink("/proc/self/environ", nodes.join("mine/environment.wgsl")).unwrap();
    symlink("/dev/zero", nodes.join("mine/zero.wgsl")).unwrap();
    symlink(at("elsewhere/theirs"), nodes.join("theirs")).unwrap();
    symlink(at("elsewhere/theirs"), nodes.join("lib")).unwrap();
    symlink(at("graph/shared/good.wgsl"), nodes.join("mine/good.wgsl")).unwrap();
    let pipe = nodes.join("mine/pipe.wgsl");
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let trusted = TrustedPaths::default().with_file(&nodes);
    let (mut library, _) = Library::load(Vec::new(), libraries(&[("wave", WAVE)]));
    let mut faults = library.load_folder(&nodes, &trusted);
    faults.sort_by_key(|fault| fault.path.clone());
    let told: Vec<_> = faults
        .iter()
        .map(|fault| fault.path.strip_prefix(&nodes).unwrap().to_str().unwrap())
        .collect();
    assert_eq!(
        told,
        [
            "lib",
            "mine/environment.wgsl",
            "mine/key.wgsl",
            "mine/pipe.wgsl",
            "mine/zero.wgsl",
            "theirs"
        ]
    );
    for fault in &faults {
        let text = fault.to_string();
        assert!(
            text.contains("is not read") && !text.contains("SECRET") && fault.snippet.is_empty(),
            "{text}"
        );
    }
    assert!(
        library.kind("mine/good").is_some(),
        "a link within the folder of the graph"
    );
    assert_eq!(files_of_folder(&nodes, &trusted), [nodes.join("mine/good.wgsl")]);
    // The node folder itself can be a link that was delivered with the graph. Its target is not trusted either.
    let linked = at("graph/linked");
    symlink(at("elsewhere"), &linked).unwrap();
    let faults = library.load_folder(&linked, &trusted);
    let [fault] = faults.as_slice() else {
        panic!("{faults:?}")
    };
    assert_eq!(fault.path, linked);
    assert!(files_of_folder(&linked, &trusted).is_empty() && library.kind("theirs/good").is_none());
    // The file is read once its place is trusted.
    let trusted = trusted.with_path(&at("elsewhere"));
    assert_eq!(library.load_folder(&linked, &trusted), []);
    assert!(library.kind("theirs/good").is_some());
}

#[test]
fn the_limits_of_a_node_folder_apply_to_all_categories_together() {
    let folder = tempfile::tempdir().unwrap();
    for category in 0..3 {
        let category = folder.path().join(format!("c{category}"));
        fs::create_dir(&category).unwrap();
        for file in 0..2000 {
            fs::write(category.join(format!("n{file}.wgsl")), "").unwrap();
        }
    }
    let trusted = TrustedPaths::default().with_path(folder.path());
    assert_eq!(files_of_folder(folder.path(), &trusted).len(), 4096 - 3);
}

#[test]
fn a_missing_folder_is_reported() {
    let mut library = Library::default();
    let faults = library.load_folder(std::path::Path::new("no/such/folder"), &TrustedPaths::default());
    assert!(faults[0].message.contains("cannot be read"));
}

#[test]
fn a_hostile_file_is_reported_with_its_line_and_the_others_are_read() {
    let node = |text: String| format!("//! Own\n//! A test.\n\n{text}");
    let mask = |value: &str| format!("/// M.\nfn mask(at: Surface) -> f32 {{ return {value}; }}\n");
    let chain = |first: &str, count: u32, next: &dyn Fn(u32) -> String| {
        format!("{first}\n{}", (1..count).map(next).collect::<String>())
    };
    let doubling = chain("fn k0(x: i32) -> i32 { return x; }", 26, &|i| {
        let before = i - 1;
        format!("fn k{i}(x: i32) -> i32 {{ return k{before}(x * 2) + k{before}(x * 2 + 1); }}\n")
    });
    let (open, close) = ("{".repeat(40), "}".repeat(40));
    let blocks = chain("fn k0(x: f32) -> f32 { return x; }", 2_000, &|i| {
        format!("fn k{i}(x: f32) -> f32 {{ {open} return k{}(x); {close} }};\n", i - 1)
    });
    let array = "fn f(x: f32) -> f32 { let t = array<f32, 100000000>(); return t[u32(x)]; }\n";
    let long = chain("fn k0(x: f32) -> f32 { return sin(x) * 2.0; }", 14, &|i| {
        format!("fn k{i}(x: f32) -> f32 {{ return k{0}(x) + k{0}(x + 1.0); }}\n", i - 1)
    });
    let sines = "fn f(x: f32) -> f32 { var y = x; for (var i = 0; i < 60000; i++) { y = sin(y); ".to_owned()
        + &"y = sin(y); ".repeat(39)
        + "} return y; }\n";
    let last = |name: &str| mask(&format!("{name}(at.uv.x)"));
    for (text, line, sentence) in [
        (doubling + &mask("f32(k25(1) + i32(at.uv.x))"), 31, "cannot be counted"),
        (blocks + &last("k1999"), 17, "leads too deep"),
        (
            array.to_owned() + &last("f"),
            4,
            "This array has 100000000 elements; 4096 are allowed.",
        ),
        (
            long + &last("k13"),
            19,
            "The code is too long: with all calls written out it costs as much as ",
        ),
        (
            sines + &last("f"),
            6,
            "operations for each texel; 16777216 are allowed.",
        ),
    ] {
        let files = vec![file("test/hostile", &node(text)), file("test/good", GOOD)];
        let (library, faults) = Library::load(files, libraries(&[("wave", WAVE)]));
        assert_eq!(
            library.kinds().map(|kind| kind.id.as_str()).collect::<Vec<_>>(),
            ["test/good"]
        );
        let [fault] = faults.as_slice() else {
            panic!("{sentence}: {faults:?}")
        };
        assert!(fault.message.contains(sentence), "{sentence}: {}", fault.message);
        assert_eq!(
            (fault.path.to_str(), fault.line),
            (Some("test/hostile.wgsl"), line),
            "{sentence}"
        );
        assert!(!fault.advice.is_empty());
    }
}

#[test]
fn a_file_just_below_the_limits_is_read_within_the_stack_of_a_thread() {
    let chain = |first: &str, count: u32, next: &dyn Fn(u32) -> String| {
        let text = format!("{first}\n{}", (1..count).map(next).collect::<String>());
        format!("//! Own\n//! A test.\n\n{text}/// M.\nfn mask(at: Surface) -> f32 {{ return last(at.uv.x); }}\n")
    };
    let (open, close) = ("{".repeat(38), "}".repeat(38));
    let operators = "x + ".repeat(240);
    for text in [
        chain("fn k0(x: f32) -> f32 { return x; }", 11, &|i| {
            format!(
                "fn k{i}(x: f32) -> f32 {{ {open} return k{}(x); {close} return x; }}\n",
                i - 1
            )
        }) + "fn last(x: f32) -> f32 { return k10(x); }\n",
        chain("fn k0(x: f32) -> f32 { return x; }", 160, &|i| {
            format!("fn k{i}(x: f32) -> f32 {{ return k{}(x); }}\n", i - 1)
        }) + "fn last(x: f32) -> f32 { return k159(x); }\n",
        chain("const a0 = 1.5;", 240, &|i| format!("const a{i} = a{} + 1.0;\n", i - 1))
            + "fn last(x: f32) -> f32 { return x * a239; }\n",
        chain("alias T0 = f32;", 240, &|i| {
            format!("alias T{i} = array<T{}, 1>;\n", i - 1)
        }) + "fn last(x: f32) -> f32 { var t: T239; let y = t; return x; }\n",
        chain("", 1, &|_| String::new()) + &format!("fn last(x: f32) -> f32 {{ return {operators}x; }}\n"),
    ] {
        let (library, faults) = Library::load(vec![file("test/own", &text)], libraries(&[]));
        assert!(faults.is_empty(), "{}", faults[0]);
        assert_eq!(library.kinds().count(), 1);
    }
}
