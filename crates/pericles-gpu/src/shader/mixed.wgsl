// The state as unevaluated sums of two floats, a high and a low part; forces in floats (Dekker 1971, Knuth 1969).
alias real = f32;
alias state = vec2<f32>;

fn rounded(s: state) -> real {
    return s.x + s.y;
}

fn widened(x: real) -> state {
    return state(x, 0.0f);
}

fn difference(a: state, b: state) -> real {
    return (a.x - b.x) + (a.y - b.y);
}

// a + b with its rounding error.
fn two_sum(a: f32, b: f32) -> state {
    let s = a + b;
    let other = s - a;
    return state(s, (a - (s - other)) + (b - other));
}

// a + b with its rounding error, for |a| >= |b|.
fn quick_sum(a: f32, b: f32) -> state {
    let s = a + b;
    return state(s, b - (s - a));
}

// The upper and lower half of the digits of a float.
fn halves(a: f32) -> vec2<f32> {
    let c = 4097.0f * a;
    let high = c - (c - a);
    return vec2<f32>(high, a - high);
}

fn sum(a: state, b: state) -> state {
    let high = two_sum(a.x, b.x);
    let low = two_sum(a.y, b.y);
    let s = quick_sum(high.x, high.y + low.x);
    return quick_sum(s.x, s.y + low.y);
}

fn product(a: state, b: state) -> state {
    let p = a.x * b.x;
    let x = halves(a.x);
    let y = halves(b.x);
    let error = ((x.x * y.x - p) + x.x * y.y + x.y * y.x) + x.y * y.y;
    return quick_sum(p, error + (a.x * b.y + a.y * b.x));
}

fn quotient(a: state, b: state) -> state {
    let first = a.x / b.x;
    let rest = sum(a, product(state(-first, 0.0f), b));
    return quick_sum(first, rest.x / b.x);
}
