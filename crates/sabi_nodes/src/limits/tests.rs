use std::path::Path;

use super::*;

/// Returns line and message of the fault of a text, if it has one.
fn fault(text: &str) -> Option<(u32, String)> {
    let mut linked = LinkedModule::default();
    linked.push_node(Path::new("a.wgsl"), text);
    check(&linked).map(|fault| (fault.line, fault.message))
}

fn is_refused(text: &str, sentence: &str) {
    let shown = &text[..text.len().min(120)];
    match fault(text) {
        Some((_, message)) => assert!(message.contains(sentence), "{shown}: {message}"),
        None => panic!("{shown}: no fault"),
    }
}

fn is_taken(text: &str) {
    assert_eq!(fault(text), None, "{}", &text[..text.len().min(120)]);
}

#[test]
fn what_is_inside_of_each_other_is_counted() {
    for text in [
        format!("fn f() {{ let x = {}1; }}", "1 + ".repeat(100_000)),
        format!("fn f() {{ let x = {}1; }}", "(".repeat(100_000)),
        format!("fn f() {{ let x = {}1; }}", "- ".repeat(1_000)),
        format!("fn f() {{ let x = a{}; }}", "[0]".repeat(1_000)),
        format!("fn f() {{ let x = 1.0{}; }}", ".x".repeat(1_000)),
        format!("fn f() {{ let x = {}2; }}", "1 < 2 > ".repeat(1_000)),
        format!("fn f() {{ if a {{}} {} }}", "else if a {} ".repeat(1_000)),
        format!(
            "fn f() {{ if a {{}} {} }}",
            "else if (a) { b(); }; ".repeat(1_000).replace("};", "}")
        ),
        format!("fn f() {}", "{".repeat(1_000)),
        format!("alias A = {}f32", "ptr<function, ".repeat(1_000)),
        format!("fn f() {{ let x: {}f32; }}", "array<".repeat(1_000)),
        format!("fn f() {{ {} }}", "for (;;) {".repeat(1_000)),
    ] {
        is_refused(&text, "too deep here: more than 256");
    }
}

#[test]
fn consecutive_statements_do_not_count_as_depth() {
    for text in [
        "fn f(a: f32) -> f32 { return a; }\n".repeat(2_000),
        "fn f() {};\n".repeat(2_000),
        format!("fn f() {{ {} }}", "if a < b { c = d; } else { c = e; }\n".repeat(2_000)),
        format!("fn f() {{ {} }}", "let x: vec2<f32> = a + b;\n".repeat(2_000)),
        format!("fn f() {{ g({}1); }}", "a + b, ".repeat(2_000)),
        format!("fn f() {{ g({}1); }}", "vec2<f32>(1.5e-3, .5), ".repeat(2_000)),
        format!(
            "fn f() {{ {} }}",
            "switch a { case 1, 2: { b += c; } default { } }\n".repeat(2_000)
        ),
    ] {
        is_taken(&text);
    }
}

#[test]
fn a_chain_of_functions_is_as_deep_as_all_of_them_together() {
    let chain = |count: usize, blocks: usize| {
        let (open, close) = ("{".repeat(blocks), "}".repeat(blocks));
        let calls = (1..count).map(|i| format!("fn f{i}() {{ {open} f{}(); {close} }};\n", i - 1));
        format!("fn f0() {{}}\n{}", calls.collect::<String>())
    };
    is_taken(&chain(10, 40));
    let (line, message) = fault(&chain(2_000, 40)).expect("too deep");
    assert_eq!(line, 14, "the first function that leads too deep");
    assert!(message.starts_with("`f13` leads too deep"), "{message}");
    is_refused(&chain(2_000, 0), "leads too deep");
}

#[test]
fn the_depths_of_constants_or_types_in_a_chain_are_added() {
    let chain =
        |first: &str, next: fn(usize) -> String| format!("{first}\n{}", (1..2_000).map(next).collect::<String>());
    for text in [
        chain("const a0 = 1;", |i| format!("const a{i} = a{};\n", i - 1)),
        chain("alias T0 = f32;", |i| format!("alias T{i} = T{};\n", i - 1)),
        chain("struct S0 { a: f32 }", |i| format!("struct S{i} {{ a: S{} }}\n", i - 1)),
        chain("fn f() { const a0 = 1;", |i| format!("const a{i} = a{};\n", i - 1)),
    ] {
        is_refused(&text, "leads too deep");
    }
}

#[test]
fn circular_names_are_left_to_the_compiler() {
    is_taken("fn a() { b(); }\nfn b() { a(); }\nconst c = c;\n");
}

#[test]
fn sizes_of_arrays_are_computed() {
    for (size, is_allowed) in [
        ("4096", true),
        ("4096u,", true),
        ("4097", false),
        ("100000000", false),
        ("0x1000", true),
        ("0x1001", false),
        ("N", true),
        ("N * N", true),
        ("N * N * N", false),
        ("M", true),
        ("M + 4000u", false),
        ("(N + 1) / 2", true),
        ("u32(N) * 65", false),
        ("N % 60 * 1025", false),
    ] {
        let text = format!("const N = 64;\nconst M: u32 = 2u * N;\nfn f() {{ var x: array<f32, {size}>; }}\n");
        match is_allowed {
            true => is_taken(&text),
            false => is_refused(&text, "elements; 4096 are allowed"),
        }
    }
    for size in ["K", "N - 65", "1 / 0", "N << 20", "max(N, 2)", "2.5", "R", "B"] {
        let text = format!(
            "const N = 64;\nconst R = 2.5;\nfn f() {{ var x: array<f32, {size}>; }}\n\
             fn g() {{ const B = 2; }}\nfn h() {{ const B = 3; }}\n"
        );
        is_refused(&text, "The size of this array is not known");
    }
}

#[test]
fn constants_that_double_each_other_are_counted_at_their_expanded_size() {
    for first in ["", "fn f() {"] {
        let doubled: String = (1..26)
            .map(|i| format!("const a{i} = array(a{0}, a{0});\n", i - 1))
            .collect();
        is_refused(&format!("{first}const a0 = 1;\n{doubled}"), "The file becomes too long");
    }
    let large = format!(
        "const A = array<f32, 4096>();\nfn f() {{ {} }}",
        "g(A[0]);".repeat(1_000)
    );
    is_refused(&large, "The file becomes too long");
    let arrays = format!("fn f() {{ {} }}", "g(array<f32, 4096>());".repeat(1_000));
    is_refused(&arrays, "The file becomes too long");
    is_taken(&format!(
        "const A = array<f32, 4096>();\nfn f() {{ {} }}",
        "g(A[0]);".repeat(100)
    ));
}

#[test]
fn no_text_makes_the_outline_panic() {
    let good = "const N = 4;\n@group(0) var<private> x: array<vec2<f32>, N>;\nfn f(a: f32) -> f32 { const K = N; \
                if a < 1.0 { return a; } else if (a >= 2e3) { } return a - -a >> 2; }\n";
    for end in (0..good.len()).filter(|end| good.is_char_boundary(*end)) {
        let _ = fault(&good[..end]);
        let _ = fault(&good[end..]);
    }
    for text in [
        "",
        "<",
        ">",
        "]",
        ")",
        "}",
        "a<",
        "a<b>",
        "const",
        "const =",
        "const a = ;",
        "array<,>",
        "array<f,>",
        "array<f,1",
        ";",
        "=",
        "}}}",
        "0x",
        "1e",
        "1.",
        ".",
        ".5.",
    ] {
        let _ = fault(text);
    }
}
