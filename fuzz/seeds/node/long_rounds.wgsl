//! Own
//! A node.

/// The mask.
fn mask(at: Surface) -> f32 {
    var s = 0.0;
    for (var i = 0u; i < 60000u; i++) { s += sin(s + 0.0) + sin(s + 1.0) + sin(s + 2.0) + sin(s + 3.0) + sin(s + 4.0) + sin(s + 5.0) + sin(s + 6.0) + sin(s + 7.0) + sin(s + 8.0) + sin(s + 9.0) + sin(s + 10.0) + sin(s + 11.0) + sin(s + 12.0) + sin(s + 13.0) + sin(s + 14.0) + sin(s + 15.0) + sin(s + 16.0) + sin(s + 17.0) + sin(s + 18.0) + sin(s + 19.0) + sin(s + 20.0) + sin(s + 21.0) + sin(s + 22.0) + sin(s + 23.0) + sin(s + 24.0) + sin(s + 25.0) + sin(s + 26.0) + sin(s + 27.0) + sin(s + 28.0) + sin(s + 29.0) + sin(s + 30.0) + sin(s + 31.0) + sin(s + 32.0) + sin(s + 33.0) + sin(s + 34.0) + sin(s + 35.0) + sin(s + 36.0) + sin(s + 37.0) + sin(s + 38.0) + sin(s + 39.0); }
    return s;
}
