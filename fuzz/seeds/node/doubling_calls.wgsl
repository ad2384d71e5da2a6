//! Own
//! A node.

/// The mask.
fn mask(at: Surface) -> f32 {
    return f32(f26(1));
}
fn f0(x: i32) -> i32 { var s = 0; for (var i = 0; i < x; i++) { s += i; } return s; }
fn f1(x: i32) -> i32 { return f0(x * 2) + f0(x * 2 + 1); }
fn f2(x: i32) -> i32 { return f1(x * 2) + f1(x * 2 + 1); }
fn f3(x: i32) -> i32 { return f2(x * 2) + f2(x * 2 + 1); }
fn f4(x: i32) -> i32 { return f3(x * 2) + f3(x * 2 + 1); }
fn f5(x: i32) -> i32 { return f4(x * 2) + f4(x * 2 + 1); }
fn f6(x: i32) -> i32 { return f5(x * 2) + f5(x * 2 + 1); }
fn f7(x: i32) -> i32 { return f6(x * 2) + f6(x * 2 + 1); }
fn f8(x: i32) -> i32 { return f7(x * 2) + f7(x * 2 + 1); }
fn f9(x: i32) -> i32 { return f8(x * 2) + f8(x * 2 + 1); }
fn f10(x: i32) -> i32 { return f9(x * 2) + f9(x * 2 + 1); }
fn f11(x: i32) -> i32 { return f10(x * 2) + f10(x * 2 + 1); }
fn f12(x: i32) -> i32 { return f11(x * 2) + f11(x * 2 + 1); }
fn f13(x: i32) -> i32 { return f12(x * 2) + f12(x * 2 + 1); }
fn f14(x: i32) -> i32 { return f13(x * 2) + f13(x * 2 + 1); }
fn f15(x: i32) -> i32 { return f14(x * 2) + f14(x * 2 + 1); }
fn f16(x: i32) -> i32 { return f15(x * 2) + f15(x * 2 + 1); }
fn f17(x: i32) -> i32 { return f16(x * 2) + f16(x * 2 + 1); }
fn f18(x: i32) -> i32 { return f17(x * 2) + f17(x * 2 + 1); }
fn f19(x: i32) -> i32 { return f18(x * 2) + f18(x * 2 + 1); }
fn f20(x: i32) -> i32 { return f19(x * 2) + f19(x * 2 + 1); }
fn f21(x: i32) -> i32 { return f20(x * 2) + f20(x * 2 + 1); }
fn f22(x: i32) -> i32 { return f21(x * 2) + f21(x * 2 + 1); }
fn f23(x: i32) -> i32 { return f22(x * 2) + f22(x * 2 + 1); }
fn f24(x: i32) -> i32 { return f23(x * 2) + f23(x * 2 + 1); }
fn f25(x: i32) -> i32 { return f24(x * 2) + f24(x * 2 + 1); }
fn f26(x: i32) -> i32 { return f25(x * 2) + f25(x * 2 + 1); }
