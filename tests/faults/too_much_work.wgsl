//! Too much work
//! Few enough rounds, with much to do in each of them.

/// The mask.
fn mask(at: Surface) -> f32 {
    var x = at.uv.x;
    for (var i = 0u; i < 60000u; i++) {
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
        x = sin(x) + cos(x);
    }
    return x;
}
