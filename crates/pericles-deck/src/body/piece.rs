//! `[[body.piece]]`: further pieces of a body, which no bond joins to the others.

use super::rotation::{Rotation, RotationScope};
use super::types::{BodyRead, Piece, SolidShape};
use crate::declaration::DeckValue;
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::bad_name;

/// Name of the piece that `[body]` describes, unless it has another one.
const MAIN: &str = "main";

/// The pieces of a body after the first one, `[body]`, as far as they could be read.
pub(super) struct Pieces<'a> {
    /// Name of the piece of `[body]`.
    main: Option<String>,
    others: Vec<PieceRead<'a>>,
}

struct PieceRead<'a> {
    name: Option<Item<'a>>,
    shape: Option<Item<'a>>,
    read: BodyRead,
    /// The piece with an empty shape.
    rest: Option<Rest>,
}

/// The keys of a piece that do not belong to its shape.
struct Rest {
    name: String,
    origin: [f64; 3],
    rotation: Option<Rotation>,
    material: Option<String>,
    velocity: Option<[f64; 3]>,
}

/// Reads the tables `[[body.piece]]` and the name of the piece of `[body]`; `shape` reads the keys of a shape.
pub(super) fn read<'a>(table: &Table<'a>, shape: impl Fn(Table<'a>) -> BodyRead) -> Pieces<'a> {
    let tables = table.tables("piece");
    const SEVERAL: &str = "it requires several pieces ([[body.piece]])";
    for key in ["rotation", "material", "velocity"] {
        table.forbid(key, "it is a key of [[body.piece]]; [body] has its own position, [material] and [[initial]]");
    }
    let main = match tables.is_empty() {
        true => {
            table.forbid("name", SEVERAL);
            None
        }
        false => table.or("name", MAIN.to_owned(), |item| name(&item)),
    };
    let others = tables.into_iter().map(|table| one(table, &shape));
    Pieces {
        main,
        others: others.collect(),
    }
}

fn one<'a>(table: Table<'a>, shape: impl Fn(Table<'a>) -> BodyRead) -> PieceRead<'a> {
    table.define("body");
    table.forbid("piece", "pieces are listed in [[body.piece]]");
    let name_item = table.required("name");
    let shape_item = table.optional("shape");
    let dimension = match shape_item.as_ref().and_then(Item::word) {
        Some("bar") => Some(1),
        Some("plate" | "disc" | "outline") => Some(2),
        // Points and meshes have a key for it.
        Some("points" | "mesh") | None => None,
        Some(_) => Some(3),
    };
    let rotation = match dimension {
        Some(1) => {
            table.forbid("rotation", "a bar cannot be rotated");
            Some(None)
        }
        _ => table.maybe("rotation", |item| {
            Rotation::read(&item, RotationScope::of_piece(dimension))
        }),
    };
    let placed = matches!(
        shape_item.as_ref().and_then(Item::word),
        Some("points" | "mesh" | "solid" | "outline")
    );
    let origin = match placed {
        true => table.maybe("origin", |item| item.vector(Quantity::Length, dimension)),
        false => Some(None),
    };
    let material = table.maybe("material", |item| item.text());
    let velocity = table.maybe("velocity", |item| {
        item.vector(Quantity::Velocity, dimension)
    });
    let read = shape(table);
    let rest = (|| {
        Some(Rest {
            name: name(name_item.as_ref()?)?,
            origin: origin?.unwrap_or_default(),
            rotation: rotation?,
            material: material?,
            velocity: velocity?,
        })
    })();
    PieceRead {
        name: name_item,
        shape: shape_item,
        read,
        rest,
    }
}

/// Reads the name of a piece, also the name of a set.
fn name(item: &Item<'_>) -> Option<String> {
    let name = item.text()?;
    match bad_name(&name) {
        Some(fault) => {
            item.report(fault());
            None
        }
        None => Some(name),
    }
}

impl Pieces<'_> {
    /// Returns the names of all pieces, `[body]` first; empty for a body of one piece.
    pub(super) fn names(&self) -> Vec<String> {
        let others = self.others.iter();
        let others = others.filter_map(|piece| piece.name.as_ref()?.word());
        let main = self.main.iter().map(String::as_str);
        main.chain(others).map(String::from).collect()
    }

    /// Adds the pieces to the body that `[body]` describes.
    pub(super) fn join(self, mut read: BodyRead) -> BodyRead {
        if self.others.is_empty() {
            return read;
        }
        read.pieces = self.names();
        let mut known: Vec<&str> = self.main.iter().map(String::as_str).collect();
        let mut right = true;
        for piece in &self.others {
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
        read.frame.mesh |= self.others.iter().any(|piece| piece.read.frame.mesh);
        let shape = read.shape.take().filter(|_| right);
        read.shape = (|| {
            let mut pieces = vec![Piece::new(self.main?, shape?)];
            for PieceRead { read, rest, .. } in self.others {
                let rest = rest?;
                pieces.push(Piece {
                    name: rest.name,
                    shape: read.shape?,
                    origin: rest.origin,
                    rotation: rest.rotation,
                    material: rest.material,
                    velocity: rest.velocity,
                });
            }
            Some(SolidShape::Pieces(pieces))
        })();
        read
    }
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
