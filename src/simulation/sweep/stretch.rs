//! The bands of several velocity fields as one list that threads divide between them.

use crate::band::Band;
use std::iter::once;

/// Bands in a row: the end of one field, then whole fields, then the beginning of another.
pub(super) struct Stretch<'a> {
    end: &'a mut [Band],
    whole: &'a mut [Vec<Band>],
    beginning: &'a mut [Band],
    /// Number of the first whole field.
    first: usize,
}

impl<'a> Stretch<'a> {
    /// All bands of all fields.
    pub fn new(fields: &'a mut [Vec<Band>]) -> Self {
        Self { end: &mut [], whole: fields, beginning: &mut [], first: 0 }
    }

    /// Number of bands.
    pub fn len(&self) -> usize {
        self.end.len() + self.whole.iter().map(Vec::len).sum::<usize>() + self.beginning.len()
    }

    /// The number of a band's field, the band before it in that field, and the band.
    pub fn at(&mut self, mut band: usize) -> (usize, Option<&mut Band>, &mut Band) {
        let whole = self.whole.iter_mut().map(Vec::as_mut_slice);
        for (k, bands) in once(&mut *self.end).chain(whole).chain(once(&mut *self.beginning)).enumerate() {
            if band < bands.len() {
                let (before, rest) = bands.split_at_mut(band);
                return (self.first + k - 1, before.last_mut(), &mut rest[0]);
            }
            band -= bands.len();
        }
        unreachable!("a part asks only for its own bands, of which none is left");
    }

    /// All of them, each with the number of its field.
    pub fn into_bands(self) -> impl Iterator<Item = (usize, &'a mut Band)> {
        let whole = self.whole.iter_mut().map(Vec::as_mut_slice);
        let pieces = once(self.end).chain(whole).chain(once(self.beginning));
        pieces.enumerate().flat_map(move |(k, bands)| bands.iter_mut().map(move |band| (self.first + k - 1, band)))
    }

    /// The first bands, and the others.
    pub fn split_at(self, mut band: usize) -> (Stretch<'a>, Stretch<'a>) {
        let Stretch { end, whole, beginning, first } = self;
        if band <= end.len() {
            let (left, right) = end.split_at_mut(band);
            let left = Stretch { end: left, whole: &mut [], beginning: &mut [], first };
            return (left, Stretch { end: right, whole, beginning, first });
        }
        band -= end.len();
        for k in 0..whole.len() {
            if band <= whole[k].len() {
                let (before, rest) = whole.split_at_mut(k);
                let [divided, after @ ..] = rest else { unreachable!("behind {k} of more fields there is another") };
                let (left, right) = divided.split_at_mut(band);
                let left = Stretch { end, whole: before, beginning: left, first };
                return (left, Stretch { end: right, whole: after, beginning, first: first + k + 1 });
            }
            band -= whole[k].len();
        }
        let next = first + whole.len() + 1;
        let (left, right) = beginning.split_at_mut(band);
        let left = Stretch { end, whole, beginning: left, first };
        (left, Stretch { end: right, whole: &mut [], beginning: &mut [], first: next })
    }
}
