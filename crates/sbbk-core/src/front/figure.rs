//! Figures 3 and 4 of the SBBK paper.
//!
//! The figures show one tree of pairs of nodes, T1 to T31. The children of T*n* are T*2n* and
//! T*2n+1*. A leaf and an inner node have such pairs below them. The paper lists the
//! nodes visited at time t2. T13 is not among them though its parent T6 is opened: T6 has one
//! child. No descent of real trees has such a pair, so this test uses the figure's tree and states
//! which nodes meet. The front is the real one.

use super::{Front, PairTest};
use crate::simd::bits;
use crate::traverse::{NodePair, Opening, Sides};
use crate::tree::Slot;

/// The tree at one time. T*n* is the slot with the packed number n.
struct Figure<'a> {
    meeting: &'a [u32],
    visited: Vec<u32>,
}

fn number(slot: Slot) -> u32 {
    2 * slot.node() + slot.lane() as u32
}

impl PairTest for Figure<'_> {
    fn roots(&self) -> (Opening, u32) {
        // T1 is lane 1 of node 0, and that is lane 2 of four.
        (Opening { nodes: (0, 0), sides: Sides::First, same_lane: 0, lanes: 0b0100 }, 0)
    }

    fn open(&self, pair: NodePair) -> (Opening, u32) {
        let n = number(pair.0);
        let lanes = if n == 6 { 0b0001 } else { 0b0101 };
        let leaves = if n >= 8 { lanes } else { 0 };
        (Opening { nodes: (n, 0), sides: Sides::First, same_lane: 0, lanes }, leaves)
    }

    fn visit(&mut self, _: NodePair) {}

    fn meeting(&mut self, opening: &Opening, asked: u32) -> u32 {
        let mut meeting = 0;
        for lane in bits(asked) {
            let n = number(opening.pair(lane).0);
            self.visited.push(n);
            meeting |= u32::from(self.meeting.contains(&n)) << lane;
        }
        meeting
    }
}

/// The nodes that `front` visits when the nodes in `meeting` meet.
fn visited(front: &mut Front, meeting: &[u32]) -> Vec<u32> {
    let mut figure = Figure { meeting, visited: Vec::new() };
    front.update(&mut figure);
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

/// The paper's two lists. Would catch a front that visits nodes above it, or forgets an entry.
#[test]
fn the_front_visits_13_nodes_and_a_fresh_descent_16() {
    let fresh = visited(&mut Front::default(), &TIME2);
    let nodes = [1, 2, 4, 5, 10, 11, 3, 6, 12, 7, 14, 28, 29, 15, 30, 31];
    assert_eq!((fresh.len(), sorted(fresh)), (16, sorted(nodes.into())));

    let mut front = Front::default();
    assert_eq!(sorted(visited(&mut front, &TIME1)), [1, 2, 3, 6, 7, 14, 15]);
    let again = visited(&mut front, &TIME2);
    let nodes = [2, 4, 5, 10, 11, 6, 12, 14, 28, 29, 15, 30, 31];
    assert_eq!((again.len(), sorted(again.clone())), (13, sorted(nodes.into())));
    // Deepest first: T14 and T15 before T6, and that before T2.
    let place = |n| again.iter().position(|&visited| visited == n);
    assert!(place(14) < place(6) && place(15) < place(6) && place(6) < place(2), "{again:?}");
}

/// Back at t1, one query raises the front to that of t1. The next one visits it, and T7 above it.
#[test]
fn a_front_goes_back_up() {
    let mut front = Front::default();
    for (meeting, cells) in [(&TIME1[..], 4), (&TIME2, 9), (&TIME1, 4)] {
        visited(&mut front, meeting);
        assert_eq!(front.len(), cells);
    }
    assert_eq!(sorted(visited(&mut front, &TIME1)), [2, 6, 7, 14, 15]);
}
