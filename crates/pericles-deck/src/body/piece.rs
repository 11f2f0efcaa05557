//! `[body]` and `[[body.piece]]`: pieces of a body, which no bond joins.

use pericles_deck_derive::DeckTable;

use super::rotation::{Rotation, RotationScope};
use super::shape::{GivenShape, OF_PIECE};
use super::types::{BodyRead, Piece, SolidShape};
use crate::declaration::{Check, DeckKeys, Spatial};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::reader::{Item, Table};
use crate::set::bad_name;

/// Name of the piece that `[body]` describes, unless it has another one.
const MAIN: &str = "main";

/// The keys of a piece that do not belong to its shape.
#[derive(DeckTable)]
#[deck(scope = PieceScope)]
pub(super) struct PieceKeys {
    /// Name of the piece, which is also the name of the set of its points. Required for further pieces; default for the piece
    /// of `[body]`: "main".
    #[deck(
        with = name,
        check = check_name,
        default = MAIN.to_owned(),
        required_if(scope.is_further),
        forbid_if(!scope.is_further && !scope.has_further, "it requires several pieces ([[body.piece]])")
    )]
    name: String,
    #[deck(
        scope = RotationScope::of_piece(scope.dimension),
        forbid_if(!scope.is_further, OF_PIECE),
        forbid_if(scope.dimension == Some(1), "a bar cannot be rotated")
    )]
    rotation: Option<Rotation>,
    /// Further pieces: name of the material. Default: the material of the body. `[[assign]]` takes precedence.
    #[deck(forbid_if(!scope.is_further, OF_PIECE))]
    material: Option<String>,
    /// Further pieces: initial velocity. `[[initial]]` replaces it.
    #[deck(quantity = Velocity, forbid_if(!scope.is_further, OF_PIECE))]
    velocity: Option<[f64; 3]>,
}

impl PieceKeys {
    /// Returns the keys of a piece of a model.
    pub(super) fn of(piece: &Piece) -> Self {
        Self {
            name: piece.name.clone(),
            rotation: piece.rotation,
            material: piece.material.clone(),
            velocity: piece.velocity,
        }
    }
}

/// Scope of the keys of a piece.
#[derive(Clone, Copy)]
pub(super) struct PieceScope {
    /// Dimension of the shape; none if another key states it.
    pub(super) dimension: Option<usize>,
    /// Whether it is a table of `[[body.piece]]`.
    pub(super) is_further: bool,
    /// Whether `[body]` has further pieces.
    pub(super) has_further: bool,
}

impl Spatial for PieceScope {
    fn dimension(&self) -> Option<usize> {
        self.dimension
    }
}

/// A piece as far as it could be read.
pub(super) struct PieceRead<'a> {
    name: Option<Item<'a>>,
    shape: Option<Item<'a>>,
    keys: Option<PieceKeys>,
    read: BodyRead,
    /// Position of the origin of a file's coordinates, m.
    origin: [f64; 3],
}

const PIECES: &str = "Further pieces of the body, each with the keys of `[body]`. No bond joins points of different pieces; they interact by `[contact]`. `spacing`, `thickness`, `area` and `plane` are taken from `[body]` if omitted. The points form one grid if all pieces lie on the cells of one lattice, otherwise a neighbour list is used. Points of different pieces must be at least half a cell apart; points one cell apart touch.";

/// Reads `[body]` with its further pieces; `shape` reads the keys of a shape.
pub(super) fn read<'a>(
    table: Table<'a>,
    shape: impl Fn(&Table<'a>, bool) -> (BodyRead, [f64; 3]) + Copy,
) -> BodyRead {
    table.describe("piece", PIECES);
    let tables = table.tables("piece");
    let has_further = !tables.is_empty();
    let others = tables.into_iter().map(|table| {
        table.define("body");
        table.forbid("piece", "pieces are listed in [[body.piece]]");
        one(table, [true, false], shape)
    });
    let others: Vec<PieceRead<'_>> = others.collect();
    join(one(table, [false, has_further], shape), others)
}

fn one<'a>(
    table: Table<'a>,
    [is_further, has_further]: [bool; 2],
    shape: impl Fn(&Table<'a>, bool) -> (BodyRead, [f64; 3]),
) -> PieceRead<'a> {
    let word = table.optional("shape");
    let dimension = word.as_ref().and_then(Item::word);
    let dimension = dimension.and_then(GivenShape::dimension);
    let scope = PieceScope {
        dimension,
        is_further,
        has_further,
    };
    let keys = PieceKeys::read_keys(&table, scope);
    let name = table.read_before("name");
    let (read, origin) = shape(&table, is_further);
    table.finish();
    PieceRead {
        name,
        shape: word,
        keys,
        read,
        origin,
    }
}

/// Reads the name of a piece, also the name of a set.
fn name(item: &Item<'_>, _: PieceScope) -> Option<String> {
    let name = item.text()?;
    match bad_name(&name) {
        Some(fault) => {
            item.report(fault());
            None
        }
        None => Some(name),
    }
}

fn check_name(name: &str, path: &KeyPath, _: PieceScope, check: &mut Check) {
    let allowed = "allowed: a name of letters, digits, - and _ that is not reserved";
    check.within(bad_name(name).is_none(), path.key("name"), name, allowed);
}

/// Adds further pieces to the piece of `[body]`.
fn join(main: PieceRead<'_>, others: Vec<PieceRead<'_>>) -> BodyRead {
    let mut read = main.read;
    if others.is_empty() {
        return read;
    }
    let main_name = main.keys.map(|keys| keys.name);
    let mut known: Vec<&str> = main_name.iter().map(String::as_str).collect();
    let mut right = true;
    for piece in &others {
        if let Some(item) = &piece.name
            && let Some(name) = item.word()
        {
            if known.contains(&name) {
                item.report(Fault::BadName {
                    name: name.into(),
                    reason: "another piece has this name",
                    allowed: "allowed: a name that no other piece has",
                });
                right = false;
            }
            known.push(name);
        }
        right &= piece.fits(&read);
    }
    read.pieces = known.into_iter().map(String::from).collect();
    read.frame.mesh |= others.iter().any(|piece| piece.read.frame.mesh);
    let shape = read.shape.take().filter(|_| right);
    read.shape = (|| {
        let mut pieces = vec![Piece::new(main_name?, shape?)];
        for piece in others {
            let keys = piece.keys?;
            pieces.push(Piece {
                name: keys.name,
                shape: piece.read.shape?,
                origin: piece.origin,
                rotation: keys.rotation,
                material: keys.material,
                velocity: keys.velocity,
            });
        }
        Some(SolidShape::Pieces(pieces))
    })();
    read
}

impl PieceRead<'_> {
    /// Reports a piece that cannot be part of the body.
    fn fits(&self, body: &BodyRead) -> bool {
        let Some(item) = &self.shape else {
            return false;
        };
        if self.read.surface.is_some() || body.surface.is_some() {
            item.out_of_range(
                "shapes of bodies with volume; contact of 2-manifolds is not supported",
            );
            return false;
        }
        let (own, whole) = (self.read.frame.dimension, body.frame.dimension);
        if own.is_some() && whole.is_some() && own != whole {
            item.out_of_range("shapes of the dimension of the body");
            return false;
        }
        let (Some(own), Some(whole)) = (&self.read.shape, &body.shape) else {
            return false;
        };
        if self.read.state != body.state || own.section() != whole.section() {
            item.out_of_range("a piece with the `plane`, `thickness` and `area` of [body]");
            return false;
        }
        let rejected = |shape: &SolidShape| {
            shape.is_periodic() || shape.has_gauss_nodes() || shape.is_refined()
        };
        if rejected(own) || rejected(whole) {
            item.out_of_range(
                "pieces that are not periodic, have one point per cell and one cell size each",
            );
            return false;
        }
        true
    }
}
