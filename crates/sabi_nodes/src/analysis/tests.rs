mod channels;
mod loops;

use std::path::PathBuf;

use crate::kind::Kind;
use crate::{Libraries, Library, SourceFile, read_kind};

/// Reads a node with these declarations. Returns the kind, or the first message.
fn read(text: &str) -> Result<Kind, String> {
    let core = Library::builtin_files().1.text("core").unwrap().to_owned();
    let libraries = Libraries([("core".to_owned(), core)].into());
    read_with(&libraries, &format!("\n{text}"))
}

/// Reads a node like [`read`], with libraries. The text starts inside the header, which it may continue.
fn read_with(libraries: &Libraries, text: &str) -> Result<Kind, String> {
    let file = SourceFile {
        path: PathBuf::from("test/node.wgsl"),
        id: "test/node".to_owned(),
        text: format!("//! Test\n//! A test.\n{text}"),
    };
    read_kind(&file, libraries).map_err(|faults| faults[0].message.clone())
}

const TWO: &str = "struct Params {\n/// A.\n/// @default 0\na: f32,\n/// B.\n/// @default 0\nb: f32,\n}\n";

/// Returns true if both parameters count as used by these functions.
fn uses_both(functions: &str) -> bool {
    match read(&format!("{TWO}{functions}")) {
        Ok(_) => true,
        Err(message) => {
            assert!(message.contains("no effect"), "{message}");
            false
        }
    }
}

#[test]
fn a_parameter_counts_when_a_result_depends_on_it() {
    for functions in [
        "/// M.\nfn mask(params: Params) -> f32 { return params.a * params.b; }",
        "/// M.\nfn mask(params: Params) -> f32 { return params.a; }\n/// N.\nfn more(params: Params) -> f32 { return params.b; }",
        "fn help(params: Params) -> f32 { return params.b; }\n/// M.\nfn mask(params: Params) -> f32 { return params.a + help(params); }",
        "fn help(p: Params, x: f32) -> f32 { return p.b + x; }\n/// M.\nfn mask(params: Params) -> f32 { let p = params; return help(p, p.a); }",
        "/// M.\nfn mask(params: Params) -> f32 { var x = params.a; if params.b > 0.0 { x = 1.0; } return x; }",
        "/// M.\nfn mask(params: Params) -> f32 { var x = array<f32, 4>(); x[u32(params.b)] = params.a; return x[1]; }",
        "fn put(x: ptr<function, f32>, v: f32) { *x = v; }\n/// M.\nfn mask(params: Params) -> f32 { var x = params.a; put(&x, params.b); return x; }",
        "/// M.\nfn mask(params: Params) -> f32 { switch u32(params.a) { case 0u: { return params.b; } default: { return 1.0; } } }",
    ] {
        assert!(uses_both(functions), "{functions}");
    }
}

#[test]
fn a_parameter_that_is_only_passed_around_does_not_count() {
    for functions in [
        "/// M.\nfn mask(params: Params) -> f32 { let b = params.b; return params.a; }",
        "/// M.\nfn mask(params: Params) -> f32 { var b = params.b; b = b + params.b; return params.a; }",
        "fn help(params: Params) -> f32 { return params.a; }\n/// M.\nfn mask(params: Params) -> f32 { return help(params); }",
        "fn help(params: Params, x: f32) -> f32 { return params.a; }\n/// M.\nfn mask(params: Params) -> f32 { return help(params, params.b); }",
        "fn unused(params: Params) -> f32 { return params.b; }\n/// M.\nfn mask(params: Params) -> f32 { return params.a; }",
        "fn help(params: Params) -> f32 { return params.b; }\n/// M.\nfn mask(params: Params) -> f32 { let x = help(params); return params.a; }",
    ] {
        assert!(!uses_both(functions), "{functions}");
    }
}

#[test]
fn the_cost_expands_calls() {
    let cost = |functions: &str| read(functions).unwrap().cost.all;
    let once = cost(
        "fn f(x: f32) -> f32 { return sin(x) * 2.0; }\n/// M.\nfn mask(at: Surface) -> f32 { return f(at.uv.x); }",
    );
    let twice = cost(
        "fn f(x: f32) -> f32 { return sin(x) * 2.0; }\n/// M.\nfn mask(at: Surface) -> f32 { return f(at.uv.x) + f(at.uv.y); }",
    );
    assert!(once > 5 && twice > once + 5, "{once} {twice}");
}

#[test]
fn the_cost_of_operations_follows_their_compile_time() {
    let cost = |expression: &str| {
        let text = format!("/// M.\nfn mask(at: Surface) -> f32 {{ let x = at.uv.x; return {expression}; }}");
        read(&text).unwrap().cost.all
    };
    let added = cost("x + x");
    for (expression, more) in [
        ("x * x", 0),
        ("pow(x, x)", 15),
        ("atan2(x, x)", 39),
        ("sin(x)", 11),
        // Four additions, two vectors, and the selection of a component.
        ("(vec4f(x) + vec4f(x)).x", 6),
        ("pow(vec4f(x), vec4f(x)).x", 66),
        // The division counts 32, and each of the three conversions 1.
        ("f32(u32(x) / u32(x))", 34),
    ] {
        assert_eq!(cost(expression), added + more, "{expression}");
    }
}

#[test]
fn code_that_compiles_for_long_is_refused_in_every_function_that_a_kernel_calls() {
    let libraries = Library::builtin_files().1;
    let read = |text: &str| read_with(&libraries, text);
    let chain = |count: usize| format!("var v = x;\n{}return v;", "v = atan2(v, x);\n".repeat(count));
    let output = |count: usize| {
        format!(
            "/// M.\nfn mask(at: Surface) -> f32 {{ let x = at.uv.x; {} }}",
            chain(count)
        )
    };
    let pass = |count: usize| {
        format!(
            "//! @use surface\n\n/// P.\n/// @pass 1\nfn first(at: Surface) -> f32 {{ let x = at.uv.x; {} }}\n/// M.\nfn mask(at: Surface, first: texture_2d_array<f32>) -> f32 {{ return surface_here(first, at).x; }}",
            chain(count)
        )
    };
    for text in [output(1000), pass(1000)] {
        let why = read(&text).unwrap_err();
        assert!(why.starts_with("The code is too long"), "{why}");
    }
    for text in [output(700), pass(700)] {
        read(&text).unwrap();
    }
    // Branches, stores and selections of elements count as code, too.
    let branches = |count: usize| {
        let ifs = "if b { v = x; }\n".repeat(count);
        format!(
            "\n/// M.\nfn mask(at: Surface) -> f32 {{ let x = at.uv.x; let b = x > 0.5; var v = x;\n{ifs}return v; }}"
        )
    };
    let elements = |count: usize| {
        let reads = "v += a[i32(v) & 63];\n".repeat(count);
        format!(
            "\n/// M.\nfn mask(at: Surface) -> f32 {{ let x = at.uv.x; var a: array<f32, 64>; a[i32(8.0 * x) & 63] = x; var v = x;\n{reads}return v; }}"
        )
    };
    for text in [branches(7_000), elements(1_000)] {
        let why = read(&text).unwrap_err();
        assert!(why.starts_with("The code is too long"), "{why}");
    }
    for text in [branches(5_000), elements(500)] {
        read(&text).unwrap();
    }
}

#[test]
fn a_text_just_below_the_depth_limit_is_accepted() {
    for text in [
        format!(
            "/// M.\nfn mask(at: Surface) -> f32 {{ return {}at.uv.x; }}",
            "at.uv.x + ".repeat(80)
        ),
        format!(
            "/// M.\nfn mask(at: Surface) -> f32 {{ let x = at.uv.x; return {}x; }}",
            "x + ".repeat(250)
        ),
        format!(
            "/// M.\nfn mask(at: Surface) -> f32 {{ let x = at.uv.x; return {}x; }}",
            "- ".repeat(250)
        ),
        format!(
            "/// M.\nfn mask(at: Surface) -> f32 {{ let x = at.uv.x; if x > 0.0 {{ return 1.0; }} {}return x; }}",
            "else if x > 1.0 { return 2.0; } ".repeat(100)
        ),
    ] {
        let _ = read(&text);
    }
    let lets: String = (1..5_000)
        .map(|i| format!("let x{i} = x{} + x{};\n", i - 1, i - 1))
        .collect();
    let text = format!("/// M.\nfn mask(at: Surface) -> f32 {{ let x0 = at.uv.x;\n{lets}return x4999; }}");
    read(&text).unwrap();
}

#[test]
fn every_value_has_a_limit_of_its_size() {
    let large = "struct Large { a: array<vec4f, 1024>, b: f32 }\n";
    let node = |declarations: &str, statements: &str| {
        let text =
            format!("{large}{declarations}\n/// M.\nfn mask(at: Surface) -> f32 {{ {statements} return at.uv.x; }}\n");
        read(&text).map(|kind| kind.cost.all)
    };
    for (declarations, statements, what) in [
        ("", "var x: Large;", "The variable `x`"),
        ("", "let x = Large();", "This value"),
        ("fn f(x: Large) -> f32 { return 1.0; }", "", "The argument `x` of `f`"),
        (
            "fn f(x: ptr<function, Large>) -> f32 { return 1.0; }",
            "",
            "The argument `x` of `f`",
        ),
        ("const X = Large();", "", "The constant `X`"),
        ("fn f() -> Large { var x: Large; return x; }", "", "The result of `f`"),
    ] {
        let message = node(declarations, statements).expect_err(what);
        assert_eq!(
            message,
            format!("{what} is larger than 16 KiB."),
            "{declarations}{statements}"
        );
    }
    assert!(node("", "var x: array<vec4f, 1024>;").is_ok());
    let message = node("", "var x: array<vec4f, 1000>; var y: array<vec4f, 1000>;").unwrap_err();
    assert_eq!(
        message,
        "The memory of all variables of `mask` together is larger than 16 KiB."
    );
}

#[test]
fn large_values_count_as_code() {
    let node = |count: usize| {
        let text = format!(
            "/// M.\nfn mask(at: Surface) -> f32 {{ {} return at.uv.x; }}\n",
            "let x = array<f32, 4096>();\n{ ".repeat(count) + &"}".repeat(count)
        );
        read(&text).map(|kind| kind.cost.all)
    };
    assert!(node(2).unwrap() > node(1).unwrap() + 1000);
    assert!(node(40).unwrap_err().contains("The code is too long"));
}

#[test]
fn a_chain_of_variables_is_followed_to_its_start() {
    let count = 4_000;
    let declared: String = (0..count).map(|i| format!("var x{i}: f32;\n")).collect();
    let stored: String = (1..count).rev().map(|i| format!("x{i} = x{};\n", i - 1)).collect();
    let text = |last: &str| {
        format!(
            "/// M.\n/// @input source A.\nfn mask(source: f32) -> f32 {{ {declared} x0 = source;\n{stored} return {last}; }}\n"
        )
    };
    assert_eq!(read(&text("x3999")).map(|_| ()), Ok(()));
    assert!(
        read(&text("1.0"))
            .unwrap_err()
            .contains("The input `source` has no effect")
    );
}
