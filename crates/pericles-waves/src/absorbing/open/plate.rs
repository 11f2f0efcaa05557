//! Nodes of a plate, its open ends, and the zone of nodes that a layer reads.

/// An end of the body along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// An open end with the number of cells of its layer.
    Open(usize),
    /// A free end.
    Free,
    /// Joined with the opposite end.
    Periodic,
}

/// Nodes of the body along an axis and its two ends, the lower one first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) nodes: usize,
    pub(super) ends: [End; 2],
}

/// The node at a given number of steps from another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// A node of the body.
    Node(usize),
    /// A node beyond an open end.
    Beyond,
    /// No node.
    Nothing,
}

impl Line {
    /// Number of cells of the layer at an end; `None` if it is not open.
    pub(super) fn cells(&self, end: usize) -> Option<usize> {
        match self.ends[end] {
            End::Open(cells) => Some(cells),
            End::Free | End::Periodic => None,
        }
    }

    /// Depth of a node below the interface of the layer at an open end, in cells; negative before the interface.
    pub(super) fn depth(&self, end: usize, index: usize) -> Option<isize> {
        let cells = self.cells(end)? as isize;
        Some(match end {
            0 => cells - index as isize,
            _ => index as isize - (self.nodes as isize - 1 - cells),
        })
    }

    /// The node with a depth at an open end.
    pub(super) fn index(&self, end: usize, depth: isize) -> usize {
        let cells = self.cells(end).unwrap_or(0) as isize;
        let index = match end {
            0 => cells - depth,
            _ => self.nodes as isize - 1 - cells + depth,
        };
        index as usize
    }

    /// Returns whether a node is in a layer or at most `margin` nodes before it.
    pub(super) fn is_near(&self, index: usize, margin: usize) -> bool {
        let near = |end| {
            self.depth(end, index)
                .is_some_and(|n| n >= -(margin as isize))
        };
        near(0) || near(1)
    }

    /// Nodes of the body from an end to `margin` nodes before its layer; zero if the end is not open.
    pub(super) fn extent(&self, end: usize, margin: usize) -> usize {
        self.cells(end).map_or(0, |cells| cells + 1 + margin)
    }

    /// The mirror image about an end of the node `shift` steps from a node, which is beyond this end.
    pub(super) fn mirrored(&self, index: usize, shift: isize) -> usize {
        let place = index as isize + shift;
        let image = if place < 0 {
            -1 - place
        } else {
            2 * self.nodes as isize - 1 - place
        };
        image.clamp(0, self.nodes as isize - 1) as usize
    }

    /// The node `shift` steps from a node.
    pub(super) fn step(&self, index: usize, shift: isize) -> Step {
        let place = index as isize + shift;
        let nodes = self.nodes as isize;
        if (0..nodes).contains(&place) {
            return Step::Node(place as usize);
        }
        match self.ends[usize::from(place >= nodes)] {
            End::Open(_) => Step::Beyond,
            End::Free => Step::Nothing,
            End::Periodic => Step::Node(place.rem_euclid(nodes) as usize),
        }
    }
}

/// Nodes in the layers and up to a margin before them, row by row.
#[derive(Debug, Clone)]
pub(super) struct Zone {
    pub(super) lines: [Line; 2],
    /// Nodes of a row in the zone of the lower and upper end along x.
    sides: [usize; 2],
    rows: Vec<Row>,
    len: usize,
}

#[derive(Debug, Clone, Copy)]
struct Row {
    start: usize,
    /// Whether all nodes of the row are in the zone.
    is_full: bool,
}

impl Zone {
    pub(super) fn new(lines: [Line; 2], margin: usize) -> Self {
        let [left, right] = [0, 1].map(|end| lines[0].extent(end, margin));
        // The margins of opposite layers may overlap.
        let sides = [left, right.min(lines[0].nodes - left)];
        let mut len = 0;
        let row = |y: usize| {
            let start = len;
            let is_full = lines[1].is_near(y, margin);
            len += if is_full {
                lines[0].nodes
            } else {
                sides[0] + sides[1]
            };
            Row { start, is_full }
        };
        Self {
            rows: (0..lines[1].nodes).map(row).collect(),
            lines,
            sides,
            len,
        }
    }

    /// Number of nodes.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Number of a node in the zone.
    pub(super) fn number(&self, [x, y]: [usize; 2]) -> Option<usize> {
        let (row, [left, right]) = (self.rows[y], self.sides);
        let before = self.lines[0].nodes - right;
        if row.is_full || x < left {
            Some(row.start + x)
        } else if x >= before {
            Some(row.start + left + x - before)
        } else {
            None
        }
    }

    /// The nodes in the order of their numbers.
    pub(super) fn nodes(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let all =
            (0..self.lines[1].nodes).flat_map(|y| (0..self.lines[0].nodes).map(move |x| [x, y]));
        all.filter(|&node| self.number(node).is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_and_nodes_are_inverse() {
        let line = Line {
            nodes: 30,
            ends: [End::Open(4), End::Open(6)],
        };
        for end in [0, 1] {
            for depth in -3..=4 {
                assert_eq!(line.depth(end, line.index(end, depth)), Some(depth));
            }
        }
        assert_eq!((line.index(0, 4), line.index(1, 6)), (0, 29));
        assert_eq!(line.step(29, 1), Step::Beyond);
    }

    #[test]
    fn numbers_of_a_zone_follow_its_nodes() {
        let line = |nodes, ends| Line { nodes, ends };
        let lines = [
            line(20, [End::Open(3), End::Free]),
            line(17, [End::Free, End::Open(2)]),
        ];
        let zone = Zone::new(lines, 2);
        let numbers: Vec<_> = zone.nodes().map(|node| zone.number(node)).collect();
        let expected: Vec<_> = (0..zone.len()).map(Some).collect();
        assert_eq!(numbers, expected);
        // Twelve rows with the six nodes at the lower end, five full ones.
        assert_eq!(zone.len(), 12 * 6 + 5 * 20);
    }
}
