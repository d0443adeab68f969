//! A text handed out line by line, so that the line on which a parser gave up is known.

use std::io::{BufRead, Error, ErrorKind, Read, Result, Seek, SeekFrom};

use super::MeshErrorCause;

/// Reads from a text, at most to the end of a line at a time: whatever buffer a parser puts in
/// between, it has asked for no line after the one that it fails on.
pub(super) struct LineReader<'a> {
    text: &'a str,
    position: usize,
}

impl<'a> LineReader<'a> {
    pub fn new(text: &'a str) -> Self {
        Self { text, position: 0 }
    }

    /// An error about the line read last, with `lines_before` lines of the file before this text.
    pub fn error(&self, lines_before: usize, problem: String) -> MeshErrorCause {
        let read = &self.text[..self.position];
        MeshErrorCause::Line {
            line: lines_before + read.lines().count(),
            text: read.lines().last().unwrap_or_default().trim().to_owned(),
            problem,
        }
    }
}

impl Read for LineReader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let count = self.fill_buf()?.read(buffer)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for LineReader<'_> {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        let rest = &self.text.as_bytes()[self.position..];
        let line_end = rest.iter().position(|&byte| byte == b'\n');
        Ok(&rest[..line_end.map_or(rest.len(), |end| end + 1)])
    }

    fn consume(&mut self, count: usize) {
        self.position += count;
    }
}

impl Seek for LineReader<'_> {
    /// Back to the start, which is all that the probing of a format needs.
    fn seek(&mut self, target: SeekFrom) -> Result<u64> {
        match target {
            SeekFrom::Start(0) => {
                self.position = 0;
                Ok(0)
            }
            _ => Err(Error::from(ErrorKind::Unsupported)),
        }
    }
}
