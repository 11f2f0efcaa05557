// The parts of a step of velocity Verlet that concern single points, loads, constraints and damping layers.
//
// Lengths, times and accelerations are in units of the body (see `Units`); work and impulse are per unit of mass.

struct Now {
    // Number of the step in the batch.
    number: u32,
    // One plus the number of the step that ends; zero for none.
    finish: u32,
    // One plus the number of the step that begins; zero for none.
    begin: u32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> now: Now;
@group(0) @binding(1) var<storage, read_write> u: array<state>;
@group(0) @binding(2) var<storage, read_write> v: array<state>;
@group(0) @binding(3) var<storage, read_write> a: array<real>;
// Intact bonds, one bit per offset.
@group(0) @binding(4) var<storage, read_write> bits: array<u32>;
// Energy dissipated by the points.
@group(0) @binding(5) var<storage, read_write> lost: array<real>;
// The first step with a bond for which the step was too long.
@group(0) @binding(6) var<storage, read_write> control: array<atomic<u32>>;
// Work, impulses, reactions and pulls of loads, constraints and layers.
@group(0) @binding(7) var<storage, read_write> books: array<real>;
// p = A theta/m of the points of a solid.
@group(0) @binding(8) var<storage, read_write> pressures: array<real>;
@group(0) @binding(9) var<storage, read> lists: array<u32>;
@group(0) @binding(10) var<storage, read> numbers: array<real>;
@group(0) @binding(11) var<storage, read> amplitudes: array<state>;
// Time functions, one row per step.
@group(0) @binding(12) var<storage, read> course: array<state>;

const NOWHERE = 0xffffffffu;

// The place of an invocation; NOWHERE beyond the body.
fn place_of(id: vec3<u32>) -> u32 {
    if (id.x >= SHAPE_X || id.y >= SHAPE_Y || id.z >= SHAPE_Z) {
        return NOWHERE;
    }
    return id.x + SHAPE_X * (id.y + SHAPE_Y * id.z);
}

// The item of an invocation of a loop over a list.
fn item_of(id: vec3<u32>) -> u32 {
    return id.x + id.y * LINE;
}

fn at(row: u32, column: u32) -> state {
    return course[row * COURSE + column];
}

fn length_of(row: u32) -> state {
    return at(row, 0u);
}

fn half_kick(v: state, a: real, dt: state) -> state {
    return sum(v, product(widened(HALF * a), dt));
}

// Ends a step and begins the next one for the points that move freely.
@compute @workgroup_size(GROUP_X, GROUP_Y, GROUP_Z)
fn turn(@builtin(global_invocation_id) id: vec3<u32>) {
    let place = place_of(id);
    if (place == NOWHERE) {
        return;
    }
    let flags = lists[FLAGS + place];
    if ((flags & OWN) == 0u) {
        return;
    }
    for (var c = 0u; c < DIMENSION; c++) {
        if ((flags & (GUIDED << c)) != 0u) {
            continue;
        }
        let k = c * PITCH + MARGIN + place;
        var speed = v[k];
        if (now.finish != 0u) {
            speed = half_kick(speed, a[k], length_of(now.finish - 1u));
        }
        if (now.begin != 0u) {
            let dt = length_of(now.begin - 1u);
            speed = half_kick(speed, a[k], dt);
            u[k] = sum(u[k], product(dt, speed));
        }
        v[k] = speed;
    }
}

// Columns of a constraint in a row of the course: whether it acts, and unit displacement before and after the step, unit
// velocity before and after, unit acceleration after.
fn column_of(motion: u32) -> u32 {
    return MOTION_COURSE + 6u * motion;
}

// As `turn`, for constrained components.
@compute @workgroup_size(LIST_GROUP)
fn guide(@builtin(global_invocation_id) id: vec3<u32>) {
    let e = item_of(id);
    if (e >= MOTIONS) {
        return;
    }
    let k = lists[MOTION_ENTRY + e];
    let column = column_of(lists[MOTION_NUMBER + e]);
    let amplitude = amplitudes[MOTION_AMPLITUDE + e];
    var speed = v[k];
    if (now.finish != 0u) {
        let row = now.finish - 1u;
        speed = half_kick(speed, a[k], length_of(row));
        if (rounded(at(row, column)) > ZERO) {
            speed = product(amplitude, at(row, column + 4u));
        }
    }
    if (now.begin != 0u) {
        let row = now.begin - 1u;
        let dt = length_of(row);
        if (rounded(at(row, column)) > ZERO) {
            let before = product(amplitude, at(row, column + 1u));
            let after = product(amplitude, at(row, column + 2u));
            speed = quotient(sum(after, -before), dt);
            u[k] = sum(amplitudes[MOTION_START + e], after);
        } else {
            speed = half_kick(speed, a[k], dt);
            u[k] = sum(u[k], product(dt, speed));
        }
    }
    v[k] = speed;
}

// Adds loads to the accelerations and their work to the books.
@compute @workgroup_size(LIST_GROUP)
fn load(@builtin(global_invocation_id) id: vec3<u32>) {
    let item = item_of(id);
    if (item >= LOADED) {
        return;
    }
    let k = lists[LOAD_ENTRY + item];
    let dt = rounded(length_of(now.number));
    let speed = rounded(v[k]);
    var force = a[k];
    for (var e = lists[LOAD_FIRST + item]; e < lists[LOAD_FIRST + item + 1u]; e++) {
        let column = LOAD_COURSE + 2u * lists[LOAD_NUMBER + e];
        let amplitude = rounded(amplitudes[LOAD_AMPLITUDE + e]);
        let before = amplitude * rounded(at(now.number, column));
        let after = amplitude * rounded(at(now.number, column + 1u));
        force += after;
        books[LOAD_WORK + e] += HALF * dt * (before + after) * speed;
    }
    a[k] = force;
}

// Reactions, work and impulses of constraints; sets their accelerations.
@compute @workgroup_size(LIST_GROUP)
fn react(@builtin(global_invocation_id) id: vec3<u32>) {
    let e = item_of(id);
    if (e >= MOTIONS) {
        return;
    }
    let k = lists[MOTION_ENTRY + e];
    let row = now.number;
    let column = column_of(lists[MOTION_NUMBER + e]);
    let amplitude = amplitudes[MOTION_AMPLITUDE + e];
    let dt = rounded(length_of(row));
    let rate = rounded(product(amplitude, at(row, column + 5u)));
    var reaction = ZERO;
    var advance = rounded(product(amplitude, at(row, column + 3u))) * dt;
    if (rounded(at(row, column)) > ZERO) {
        reaction = rate - a[k];
        let before = product(amplitude, at(row, column + 1u));
        let after = product(amplitude, at(row, column + 2u));
        advance = difference(after, before);
        a[k] = rate;
    }
    let mean = HALF * (books[MOTION_REACTION + e] + reaction);
    books[MOTION_WORK + e] += mean * advance;
    books[MOTION_IMPULSE + e] += mean * dt;
    books[MOTION_REACTION + e] = reaction;
}

// Adds the pull of damping layers, which acts on the mean velocity of the step.
@compute @workgroup_size(LIST_GROUP)
fn damp(@builtin(global_invocation_id) id: vec3<u32>) {
    let item = item_of(id);
    if (item >= DAMPED) {
        return;
    }
    let k = lists[LAYER_ENTRY + item];
    let dt = rounded(length_of(now.number));
    let speed = rounded(v[k]);
    var force = a[k];
    for (var e = lists[LAYER_FIRST + item]; e < lists[LAYER_FIRST + item + 1u]; e++) {
        let pull = -rounded(amplitudes[LAYER_RATE + e]) * speed;
        let mean = HALF * (books[LAYER_PULL + e] + pull);
        books[LAYER_WORK + e] += mean * dt * speed;
        books[LAYER_IMPULSE + e] += mean * dt;
        books[LAYER_PULL + e] = pull;
        force += pull;
    }
    a[k] = force;
}

// Copies the motion of points to their images beyond periodic faces.
@compute @workgroup_size(LIST_GROUP)
fn repeat(@builtin(global_invocation_id) id: vec3<u32>) {
    let item = item_of(id);
    if (item >= IMAGES) {
        return;
    }
    let place = lists[IMAGE_PLACE + item];
    let source = lists[IMAGE_SOURCE + item];
    for (var c = 0u; c < DIMENSION; c++) {
        u[c * PITCH + MARGIN + place] = u[c * PITCH + MARGIN + source];
        v[c * PITCH + MARGIN + place] = v[c * PITCH + MARGIN + source];
    }
}

// Copies the pressures of points to their images beyond periodic faces.
@compute @workgroup_size(LIST_GROUP)
fn repeat_pressures(@builtin(global_invocation_id) id: vec3<u32>) {
    let item = item_of(id);
    if (item >= IMAGES) {
        return;
    }
    pressures[MARGIN + lists[IMAGE_PLACE + item]] = pressures[MARGIN + lists[IMAGE_SOURCE + item]];
}
