// Numbers in double precision.
alias real = f64;
alias state = f64;

fn rounded(s: state) -> real {
    return s;
}

fn widened(x: real) -> state {
    return x;
}

fn difference(a: state, b: state) -> real {
    return a - b;
}

fn sum(a: state, b: state) -> state {
    return a + b;
}

fn product(a: state, b: state) -> state {
    return a * b;
}

fn quotient(a: state, b: state) -> state {
    return a / b;
}
