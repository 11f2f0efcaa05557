//! Vectors of three dimensions.

use crate::space::Point;

/// Returns a·b.
#[inline]
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns |a|.
#[inline]
pub fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// Returns a × b.
#[inline]
pub fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Returns the normal of a triangle, as long as twice its area.
#[inline]
pub fn normal([a, b, c]: [Point; 3]) -> Point {
    cross(minus(b, a), minus(c, a))
}

/// Returns a − b.
#[inline]
pub fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns a + factor b.
#[inline]
pub fn plus(a: Point, factor: f64, b: Point) -> Point {
    std::array::from_fn(|c| a[c] + factor * b[c])
}

/// Returns factor a.
#[inline]
pub fn scaled(factor: f64, a: Point) -> Point {
    a.map(|x| factor * x)
}
