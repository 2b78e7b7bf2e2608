//! From the numbers of a file to rows.

/// Rows of points by the file's numbers.
pub enum Numbering {
    /// Point `i` is row `i`, of so many.
    Rows(u64),
    /// Row by number, less the smallest number; `u32::MAX` where there is none. For numbers with few gaps.
    Table(u64, Vec<u32>),
    /// Numbers in ascending order, with their rows.
    Sorted(Vec<(u64, u32)>),
}

impl Numbering {
    /// The numbering of points; an error is a number that occurs twice.
    pub fn new(numbers: Option<&[u64]>, count: usize) -> Result<Numbering, u64> {
        let Some(numbers) = numbers else { return Ok(Numbering::Rows(count as u64)) };
        let (Some(&least), Some(&most)) = (numbers.iter().min(), numbers.iter().max()) else {
            return Ok(Numbering::Rows(0));
        };
        if most - least <= 4 * count as u64 + 1024 {
            let mut table = vec![u32::MAX; (most - least) as usize + 1];
            for (row, &number) in numbers.iter().enumerate() {
                let entry = &mut table[(number - least) as usize];
                if *entry != u32::MAX {
                    return Err(number);
                }
                *entry = row as u32;
            }
            return Ok(Numbering::Table(least, table));
        }
        let mut sorted: Vec<(u64, u32)> = numbers.iter().copied().zip(0..).collect();
        sorted.sort_unstable();
        match sorted.windows(2).find(|two| two[0].0 == two[1].0) {
            Some(twice) => Err(twice[0].0),
            None => Ok(Numbering::Sorted(sorted)),
        }
    }

    /// The row of a number.
    pub fn row(&self, number: u64) -> Option<u32> {
        match self {
            Numbering::Rows(count) => (number < *count).then_some(number as u32),
            Numbering::Table(least, table) => {
                let entry = table.get(usize::try_from(number.checked_sub(*least)?).ok()?)?;
                (*entry != u32::MAX).then_some(*entry)
            }
            Numbering::Sorted(sorted) => {
                sorted.binary_search_by_key(&number, |entry| entry.0).ok().map(|place| sorted[place].1)
            }
        }
    }
}
