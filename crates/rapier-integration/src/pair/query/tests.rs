use super::*;

/// Would catch candidates of a query that a panic cut short.
#[test]
fn candidates_serve_after_a_finished_query_only() {
    let (mut memory, pose) =
        (CandidateMemory::<()>::default(), PairPose::new(&Pose::IDENTITY, 0.1));
    memory.begin();
    memory.candidates.push(Candidate::new([1, 2]));
    memory.end(&pose, 3);
    memory.begin();
    assert!(memory.candidates.len() == 1 && !memory.is_unchanged(&pose, 3));
    memory.begin();
    assert!(memory.candidates.is_empty());
}

/// Would catch hints of other subshapes, and candidates out of order.
#[test]
fn new_candidates_are_sorted_and_keep_hints() {
    let mut memory = CandidateMemory::<u32>::default();
    for (round, numbers) in [(1, &[5, 1, 3][..]), (2, &[4, 3, 9, 1]), (3, &[9, 2])] {
        memory.replace(|found| {
            found.extend(numbers.iter().map(|&i| Candidate::new([i, 7])));
        });
        for candidate in memory.candidates.iter_mut().filter(|c| c.hint == 0) {
            candidate.hint = 10 * round + candidate.subshapes[0];
        }
    }
    let found: Vec<_> = memory.candidates.iter().map(|c| (c.subshapes[0], c.hint)).collect();
    assert_eq!(found, [(2, 32), (9, 29)]);
}

/// Would catch candidates of one great overlap that a pair keeps for ever.
#[test]
fn memory_of_candidates_is_given_back() {
    let mut memory = CandidateMemory::<()>::default();
    let pose = PairPose::new(&Pose::IDENTITY, 0.1);
    let mut query = |count: u32| {
        memory.begin();
        memory.candidates.clear();
        memory.candidates.extend((0..count).map(|i| Candidate::new([i, 0])));
        memory.end(&pose, 0);
        memory.candidates.capacity()
    };
    assert!(query(1000) >= 1000 && query(0) >= 1000);
    assert!((0..3000).map(|_| query(0)).last() < Some(10));
}
