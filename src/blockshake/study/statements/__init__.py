"""The paper, statement by statement: each judged from the results of the study at hand."""
