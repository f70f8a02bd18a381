"""Systems with contacts and joints, event by event: contacts that open, strike, and with friction stick or slide."""
