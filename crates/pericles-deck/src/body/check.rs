//! Checks of bodies made by programs: the ranges of the declared keys, and rules that decks satisfy by their form.

use super::piece::{PieceKeys, PieceScope};
use super::positions::Quadrature;
use super::shape::GivenShape;
use super::sources::{FilledCells, FilledShape};
use super::types::{Lattice, Piece, SolidShape, piece_path};
use crate::declaration::{Check, DeckKeys};
use crate::key_path::KeyPath;
use crate::range::POSITIVE;

impl SolidShape {
    /// Checks the source of the points of the body or piece at a path.
    pub(crate) fn check(&self, path: &KeyPath, check: &mut Check) {
        match self {
            Self::Lattice(lattice) => lattice.check(path, check),
            Self::Points(points) => points.check_keys(path, (), check),
            Self::Mesh(mesh) => mesh.check_keys(path, (), check),
            Self::Filled(filled) => filled.check(path, check),
            Self::Pieces(pieces) => check_pieces(pieces, path, check),
        }
    }
}

fn check_pieces(pieces: &[Piece], path: &KeyPath, check: &mut Check) {
    let allowed = "allowed: at least one piece";
    check.within(!pieces.is_empty(), path.key("piece"), pieces.len(), allowed);
    for (k, piece) in pieces.iter().enumerate() {
        let (path, shape, first) = (piece_path(k), &piece.shape, &pieces[0].shape);
        let whole = shape.pieces().is_empty()
            && !shape.is_periodic()
            && !shape.is_refined()
            && !shape.has_gauss_nodes();
        let allowed =
            "allowed: a shape that is not periodic, with one point per cell and one cell size";
        check.within(whole, path.key("shape"), &piece.name, allowed);
        if whole {
            shape.check(&path, check);
        }
        let alike = first.dimension() == shape.dimension() && first.section() == shape.section();
        let allowed = "allowed: the dimension and the `area` or `thickness` of the body";
        check.within(alike, path.key("shape"), &piece.name, allowed);
        let known = pieces[..k].iter().any(|other| other.name == piece.name);
        let allowed = "allowed: a name that no other piece has";
        check.within(!known, path.key("name"), &piece.name, allowed);
        let scope = PieceScope {
            dimension: Some(first.dimension()),
            is_further: true,
            has_further: true,
        };
        PieceKeys::of(piece).check_keys(&path, scope, check);
    }
}

impl FilledShape {
    fn check(&self, path: &KeyPath, check: &mut Check) {
        self.check_keys(path, self.dimension, check);
        let right = self.cells == FilledCells::Whole || !self.positions.are_random();
        let allowed = "allowed: \"whole\" with random positions";
        check.within(right, path.key("cells"), "partial", allowed);
        let right = self.is_on_lattice() || self.finer.is_empty();
        let allowed = "allowed: with whole cells on a lattice";
        check.within(right, path.key("refine"), self.finer.len(), allowed);
    }
}

impl Lattice {
    fn check(&self, path: &KeyPath, check: &mut Check) {
        GivenShape::of(self).check_keys(path, false, check);
        check.number(path.key("spacing"), self.grid.spacing, POSITIVE);
        let gauss = self.quadrature == Quadrature::Gauss;
        let right = !gauss || self.grid.dimension() == 1;
        let allowed = "allowed: \"midpoint\", except for a bar";
        check.within(right, path.key("quadrature"), "gauss", allowed);
        let plain = self.rectangular.is_none() && self.finer.is_empty() && !self.periodic && !gauss;
        let right = plain || !self.positions.are_random();
        let allowed = "allowed: \"lattice\" in periodic bodies, with Gauss nodes and with cells of several sizes";
        check.within(right, path.key("positions"), "random", allowed);
    }
}
