//! Figures 3 and 4 of the SBBK paper.
//!
//! The figures show one tree, T1 to T31, the children of T*n* being T*2n* and T*2n+1*: a tree of
//! pairs of nodes, with two children each, as where one side is a leaf. The paper lists the nodes
//! visited at time t2, and T13 is not among them though T6, its parent, is opened: T6 has one
//! child. No descent of real trees has such a pair, so the tree here is the figure's own, and only
//! which nodes meet is given. The front is the real one.

use std::collections::BTreeSet;

use wide::f32x4;

use super::cells::lanes;
use super::opening::{Opening, PairTest, SlotPair};
use super::{Front, FrontOptions};
use crate::traverse::Sides;
use crate::tree::Slot;

/// The tree at one time. T*n* is the slot with the packed number n.
struct Figure {
    meeting: BTreeSet<u32>,
    visited: Vec<u32>,
}

fn number(slot: Slot) -> u32 {
    2 * slot.node() + slot.lane() as u32
}

impl PairTest for Figure {
    fn roots(&self) -> Opening {
        // T1 is lane 1 of node 0, and that is lane 2 of four.
        Opening { nodes: (0, 0), sides: Sides::First, same_lane: 0, lanes: 0b0100, leaves: 0 }
    }

    fn open(&self, pair: SlotPair) -> Opening {
        let n = number(pair.0);
        let lanes = if n == 6 { 0b0001 } else { 0b0101 };
        let leaves = if n >= 8 { lanes } else { 0 };
        Opening { nodes: (n, 0), sides: Sides::First, same_lane: 0, lanes, leaves }
    }

    fn leaves(&self, pair: SlotPair) -> (u32, u32) {
        (number(pair.0), 0)
    }

    fn gaps(&mut self, opening: &Opening, asked: u8) -> f32x4 {
        let mut gaps = [f32::NAN; 4];
        for lane in lanes(asked) {
            let n = number(opening.pair(lane).0);
            self.visited.push(n);
            gaps[lane] = if self.meeting.contains(&n) { -1.0 } else { 1.0 };
        }
        f32x4::new(gaps)
    }
}

/// The nodes that `front` visits when these meet, and motion may have changed every pair.
fn visited(front: &mut Front, meeting: &[u32]) -> Vec<u32> {
    let mut figure = Figure { meeting: meeting.iter().copied().collect(), visited: Vec::new() };
    if front.cells.is_empty() {
        front.build(&mut figure, 0.0);
    } else {
        front.due.clear();
        front.cells.all(&mut front.due);
        front.test_due(&mut figure, 0.0, 0.0);
    }
    figure.visited
}

fn sorted(mut nodes: Vec<u32>) -> Vec<u32> {
    nodes.sort_unstable();
    nodes
}

/// At t1 the descent stops at T2, T6, T14 and T15, the red nodes.
const TIME1: [u32; 3] = [1, 3, 7];
/// At t2 it stops at T4, T10, T11, T12 and T28 to T31, the green ones.
const TIME2: [u32; 8] = [1, 2, 3, 5, 6, 7, 14, 15];

/// The paper's two lists. Would catch a front that visits what is above it, or forgets an entry.
#[test]
fn the_front_visits_13_nodes_and_a_fresh_descent_16() {
    let fresh = visited(&mut Front::new(FrontOptions::Paper), &TIME2);
    let nodes = [1, 2, 4, 5, 10, 11, 3, 6, 12, 7, 14, 28, 29, 15, 30, 31];
    assert_eq!((fresh.len(), sorted(fresh)), (16, sorted(nodes.into())));

    let mut front = Front::new(FrontOptions::Paper);
    assert_eq!(sorted(visited(&mut front, &TIME1)), [1, 2, 3, 6, 7, 14, 15]);
    let again = visited(&mut front, &TIME2);
    let nodes = [2, 4, 5, 10, 11, 6, 12, 14, 28, 29, 15, 30, 31];
    assert_eq!((again.len(), sorted(again.clone())), (13, sorted(nodes.into())));
    // Deepest first: T14 and T15 before T6, and that before T2.
    let place = |n| again.iter().position(|&visited| visited == n);
    assert!(place(14) < place(6) && place(15) < place(6) && place(6) < place(2), "{again:?}");
}

/// Back to t1: the paper's front stays as low as it was and visits more each time; a raised one is
/// that of t1 again.
#[test]
fn a_raised_front_goes_back_up() {
    let paper = (FrontOptions::Paper, vec![4, 10, 11, 12, 28, 29, 30, 31], 9, 0);
    for (options, expected, cell_count, raised) in [paper, (FrontOptions::Adaptive, vec![], 4, 4)] {
        let mut front = Front::new(options);
        for meeting in [&TIME1[..], &TIME2, &TIME1] {
            visited(&mut front, meeting);
        }
        let cells = front.stats().cells;
        let below: Vec<_> = sorted(visited(&mut front, &TIME1))
            .into_iter()
            .filter(|&n| expected.contains(&n))
            .collect();
        assert_eq!(below, expected);
        // The roots' cell and one for each node that meets, or ever met.
        assert_eq!(cells, cell_count);
        // T2, T6, T14 and T15 part; T5 goes with T2.
        assert_eq!(front.stats().raised, raised);
    }
}
