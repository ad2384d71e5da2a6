use std::path::Path;

use super::*;

fn scanned(text: &str) -> Result<Scan, Vec<Fault>> {
    scan(Text {
        path: Path::new("a.wgsl"),
        text,
    })
}

fn first_fault(text: &str) -> (u32, u32, String) {
    let fault = scanned(text).unwrap_err().remove(0);
    (fault.line, fault.column, fault.message)
}

#[test]
fn declarations_are_found_with_names_members_and_comments() {
    let text = "//! A\n//! B\n\nconst N = array<vec2f, 2>(vec2f(0, 1), vec2f(1, 0));\nconst_assert (1 < 2);\n\
                /// Params.\nstruct Params {\n    /// One.\n    /// Two.\n    @align(16) a: array<vec4f, 4>,\n    b: f32\n}\n;\n\
                /* plain /* nested */ */\n/// Doc.\n// plain\n@must_use\nfn mask(at: Surface, b: vec3<f32>,) -> f32 { if (1 < 2) { } return 0; }\n";
    let scan = scanned(&text.replace("/* plain /* nested */ */\n", "")).unwrap();
    assert!(scan.is_complete);
    assert_eq!(
        scan.header.iter().map(|line| line.text.as_str()).collect::<Vec<_>>(),
        ["A", "B"]
    );
    let params = scan.params().unwrap();
    assert_eq!(params.members[0].docs.len(), 2);
    assert_eq!(params.members[1].name, "b");
    let function = scan.functions().next().unwrap();
    assert_eq!((function.name.as_str(), function.docs.len()), ("mask", 1));
    assert_eq!(function.members.len(), 2);
}

#[test]
fn types_are_read_from_the_text() {
    let text = "struct Params { a: array<vec4f, 4>, b : f32 }";
    let scan = scanned(text).unwrap();
    let types: Vec<&str> = scan.items[0]
        .members
        .iter()
        .map(|member| &text[member.type_range.clone()])
        .collect();
    assert_eq!(types, ["array<vec4f, 4>", "f32"]);
}

#[test]
fn a_plain_comment_before_a_doc_comment_is_refused() {
    let (line, column, message) = first_fault("//! A\n\n// plain\n/// doc\nfn f() {}\n");
    assert_eq!((line, column), (4, 1));
    assert!(message.contains("lost"), "{message}");
    // A plain comment after code has the same effect.
    assert_eq!(
        first_fault("struct P {\n    a: f32, // plain\n    /// doc\n    b: f32,\n}").0,
        3
    );
    assert_eq!(first_fault("fn f() {} // plain\n/// doc\nfn g() {}").0, 2);
    // A block comment is refused, too.
    assert_eq!(first_fault("/* plain */\n/// doc\nfn g() {}").0, 2);
}

#[test]
fn a_plain_comment_below_a_doc_comment_is_allowed() {
    let scan = scanned("/// doc\n// plain\nfn f() {}\n").unwrap();
    assert_eq!(scan.items[0].docs.len(), 1);
}

#[test]
fn consecutive_misplaced_lines_are_reported_once() {
    let faults = scanned("// plain\n/// a\n/// b\n/// c\nfn f() {}").unwrap_err();
    assert_eq!(faults.len(), 1);
}

#[test]
fn a_doc_comment_after_code_is_refused() {
    assert_eq!(first_fault("struct P {\n    a: f32, /// doc\n}").0, 2);
    assert_eq!(first_fault("struct P { /// doc\n    a: f32,\n}").0, 1);
}

#[test]
fn doc_comments_that_document_nothing_are_reported() {
    for text in [
        "fn f() {\n    /// doc\n}",
        "fn f(\n    /// doc\n    a: f32) {}",
        "struct P {\n    a: f32,\n    /// doc\n}",
        "fn f()\n    /// doc\n{}",
        "const A =\n    /// doc\n    1;",
    ] {
        let (line, ..) = first_fault(text);
        assert!((2..=3).contains(&line), "{text}");
    }
    assert_eq!(first_fault("fn f() {}\n\n/// doc\n").0, 3);
}

#[test]
fn line_endings_of_all_systems_are_read() {
    let scan = scanned("//! A\r\n//! B\r\n\r\n/// Doc.\r\nfn f() {}\r\n").unwrap();
    assert_eq!(scan.header[1].text, "B");
    assert_eq!(scan.items[0].docs[0].text, "Doc.");
}

#[test]
fn no_text_makes_the_scanner_panic() {
    let good =
        "//! A\n/// d\nstruct P { /// x\n a: array<f32, 2>, }\n/* é */ fn f(@a(1) b: f32) -> f32 { return 1; } // ü\n";
    for end in (0..good.len()).filter(|end| good.is_char_boundary(*end)) {
        let _ = scanned(&good[..end]);
        let _ = scanned(&good[end..]);
    }
    for text in [
        "",
        "/",
        "//",
        "///",
        "//!",
        "/*",
        "/**",
        "/**/",
        "@",
        "fn",
        "fn f(",
        "struct",
        "}",
        ")",
        "a: <",
        "\u{2028}///",
    ] {
        let _ = scanned(text);
    }
}

#[test]
fn of_many_faults_only_some_are_reported() {
    assert_eq!(scanned(&"fn f() {} /// x\n".repeat(2_000)).unwrap_err().len(), 64);
    assert_eq!(scanned(&"fn f() {\n/// x\n;\n}\n".repeat(2_000)).unwrap_err().len(), 64);
}

#[test]
fn a_number_with_point_exponent_and_suffix_is_one_word() {
    for (text, words) in [
        ("1.5e-3f+x", &["1.5e-3f", "+", "x"][..]),
        (".5.x", &[".5", ".", "x"]),
        ("0x1.8p+3-1e", &["0x1.8p+3", "-", "1e"]),
        ("a.x", &["a", ".", "x"]),
        ("1e+x", &["1e", "+", "x"]),
    ] {
        let read: Vec<&str> = tokens::tokens(text)
            .iter()
            .map(|token| &text[token.range.clone()])
            .collect();
        assert_eq!(read, words, "{text}");
    }
}
