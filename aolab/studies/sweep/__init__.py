"""Parameter sweeps: `plan` lists the cases, `case` computes one, `records` keeps them, `schedule` runs them all."""
